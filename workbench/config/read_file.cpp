#include "workbench/config/read_file.hpp"

#include <cerrno>
#include <cstdio>
#include <memory>
#include <system_error>

namespace waymark {
namespace {

namespace fs = std::filesystem;

struct CloseReadFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};

Error cannot_read(const fs::path& path, const std::string& why) {
  return {"cannot read " + path.string() + ": " + why};
}

Error cannot_read(const fs::path& path, int code) {
  return cannot_read(path, std::generic_category().message(code));
}

}  // namespace

Result<void> check_is_file(const fs::path& path) {
  std::error_code failed;
  switch (const fs::file_status status = fs::status(path, failed); status.type()) {
    case fs::file_type::regular:
      return {};
    case fs::file_type::directory:
      return cannot_read(path, EISDIR);
    case fs::file_type::not_found:
      return cannot_read(path, ENOENT);
    case fs::file_type::none:
      return cannot_read(path, failed.value());
    default:
      return cannot_read(path, "not a regular file, but a device, a pipe or a socket");
  }
}

Result<std::string> read_file(const fs::path& path) {
  if (auto checked = check_is_file(path); !checked) return checked.error();
  const std::unique_ptr<std::FILE, CloseReadFile> file(std::fopen(path.c_str(), "rb"));
  if (!file) return cannot_read(path, errno);
  std::error_code unknown;
  const auto expected = fs::file_size(path, unknown);
  std::string content(unknown ? 0 : expected, '\0');
  content.resize(std::fread(content.data(), 1, content.size(), file.get()));
  // Files of the system have no size, and a file may grow while it is read.
  char chunk[65536];
  for (std::size_t count = 0; (count = std::fread(chunk, 1, sizeof chunk, file.get())) > 0;)
    content.append(chunk, count);
  if (std::ferror(file.get()) != 0) return cannot_read(path, errno);
  return content;
}

}  // namespace waymark
