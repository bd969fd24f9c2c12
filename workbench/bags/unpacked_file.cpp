#include "workbench/bags/unpacked_file.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <string>
#include <system_error>
#include <vector>

#include <fmt/format.h>

#include "workbench/bags/byte_stream.hpp"
#include "workbench/bags/decompress.hpp"

namespace waymark::bag {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kZstdMagic = "\x28\xb5\x2f\xfd";
constexpr std::uint64_t kMostOfAny = 64'000'000;
constexpr std::uint64_t kMostPerByte = 256;

struct CloseUnpacked {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using OutputFile = std::unique_ptr<std::FILE, CloseUnpacked>;

std::string reason() { return std::generic_category().message(errno); }

/// Empty: none can be made.
fs::path make_temporary_folder() {
  std::error_code failed;
  std::string name = (fs::temp_directory_path(failed) / "waymark-XXXXXX").string();
  return failed || ::mkdtemp(name.data()) == nullptr ? fs::path{} : fs::path(name);
}

/// Writes what a stream gives.
Result<void> write_all(ByteStream& stream, std::uint64_t most, std::FILE* file) {
  std::vector<char> block(1 << 20);
  for (std::uint64_t size = 0; size <= most;) {
    const auto count = stream.read(block);
    if (!count) return count.error();
    if (*count == 0) return {};
    if (std::fwrite(block.data(), 1, *count, file) != *count) return Error{reason()};
    size += *count;
  }
  return Error{fmt::format("it holds more than {} MB, which no recording shrinks so far", most / 1'000'000)};
}

Result<void> unpack_into(const std::shared_ptr<const InputFile>& packed, const fs::path& path) {
  const OutputFile file(std::fopen(path.c_str(), "wbx"));
  if (!file) return Error{reason()};
  const auto stream = decompressed(
      "zstd", std::make_unique<FileSection>(packed, 0, std::numeric_limits<std::uint64_t>::max()));
  if (auto done = write_all(*stream, kMostOfAny + kMostPerByte * packed->size(), file.get()); !done)
    return done;
  return std::fflush(file.get()) == 0 ? Result<void>{} : Error{reason()};
}

}  // namespace

bool is_zstd(std::string_view first_bytes) { return first_bytes.starts_with(kZstdMagic); }

Result<std::unique_ptr<UnpackedFile>> UnpackedFile::unpack(const fs::path& packed) {
  auto input = InputFile::open(packed);
  if (!input) return input.error();
  const fs::path folder = make_temporary_folder();
  if (folder.empty())
    return Error{fmt::format("{}: cannot be unpacked: no folder for temporary files; set TMPDIR to one",
                             packed.string())};
  const fs::path name = packed.extension() == ".zstd" ? packed.stem() : packed.filename();
  std::unique_ptr<UnpackedFile> file(new UnpackedFile(folder / name));
  if (auto done = unpack_into(*input, file->path()); !done)
    return Error{fmt::format("{}: cannot be unpacked into {}: {}", packed.string(),
                             folder.parent_path().string(), done.error().message)};
  return file;
}

UnpackedFile::~UnpackedFile() {
  std::error_code ignored;
  fs::remove_all(path_.parent_path(), ignored);
}

}  // namespace waymark::bag
