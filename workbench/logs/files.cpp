#include "workbench/logs/files.hpp"

#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <memory>
#include <system_error>

namespace waymark {
namespace {

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, CloseFile>;

Error system_error(const char* what, const std::filesystem::path& path, int code) {
  return {std::string("cannot ") + what + " " + path.string() + ": " + std::generic_category().message(code)};
}

/// False: errno says why.
bool write_all(const std::filesystem::path& path, std::string_view content) {
  File file(std::fopen(path.c_str(), "wb"));
  if (!file) return false;
  if (std::fwrite(content.data(), 1, content.size(), file.get()) != content.size()) return false;
  return std::fclose(file.release()) == 0;
}

}  // namespace

Result<void> write_file(const std::filesystem::path& path, std::string_view content) {
  std::filesystem::path part = path;
  part += ".part";
  if (write_all(part, content) && std::rename(part.c_str(), path.c_str()) == 0) return {};
  const int code = errno;
  std::remove(part.c_str());
  return system_error("write", path, code);
}

Result<void> ensure_output_folder(const std::filesystem::path& folder) {
  std::error_code failed;
  std::filesystem::create_directories(folder, failed);
  if (failed) return system_error("create the folder", folder, failed.value());
  if (!std::filesystem::is_directory(folder, failed))
    return system_error("create the folder", folder, ENOTDIR);
  if (::access(folder.c_str(), W_OK | X_OK) != 0) return system_error("write into", folder, errno);
  return {};
}

std::string base_name(const std::filesystem::path& path) {
  const auto whole = std::filesystem::absolute(path).lexically_normal();
  return (whole.has_filename() ? whole : whole.parent_path()).filename().string();
}

}  // namespace waymark
