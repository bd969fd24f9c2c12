#pragma once

#include <filesystem>
#include <memory>
#include <string_view>

#include "waymark/core/result.hpp"

namespace waymark::bag {

/// Does a file, or a message, that begins so call itself a frame of zstd?
[[nodiscard]] bool is_zstd(std::string_view first_bytes);

/// A file as it was before zstd, in a folder of its own among the temporary files ($TMPDIR, or /tmp), gone
/// with this. It is called as the packed one, without ".zstd".
class UnpackedFile {
 public:
  /// An error: it is damaged, there is no room for it, or it is more than 64 MB and 256 times as large as the
  /// packed one: sensors do not record what shrinks so far.
  [[nodiscard]] static Result<std::unique_ptr<UnpackedFile>> unpack(const std::filesystem::path& packed);
  UnpackedFile(const UnpackedFile&) = delete;
  UnpackedFile& operator=(const UnpackedFile&) = delete;
  ~UnpackedFile();

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  explicit UnpackedFile(std::filesystem::path path) : path_(std::move(path)) {}

  std::filesystem::path path_;
};

}  // namespace waymark::bag
