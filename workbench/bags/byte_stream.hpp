#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "waymark/core/result.hpp"

namespace waymark::bag {

/// Bytes that come one after another: part of a file, or what a decompressor makes of one.
class ByteStream {
 public:
  ByteStream() = default;
  ByteStream(const ByteStream&) = delete;
  ByteStream& operator=(const ByteStream&) = delete;
  virtual ~ByteStream() = default;

  /// Fills the front of `into`, which is not empty, and says how much of it; 0 at the end.
  [[nodiscard]] virtual Result<std::size_t> read(std::span<char> into) = 0;

  /// Passes over at most `count` bytes where that is cheaper than reading them, and says over how many.
  virtual std::uint64_t skip(std::uint64_t /*count*/) { return 0; }
};

/// A file that is open for reading, at any place.
class InputFile {
 public:
  [[nodiscard]] static Result<std::shared_ptr<const InputFile>> open(const std::filesystem::path& path);
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;
  ~InputFile();

  [[nodiscard]] std::uint64_t size() const { return size_; }
  [[nodiscard]] Result<std::size_t> read(std::uint64_t position, std::span<char> into) const;
  /// The first bytes; zeros behind the end.
  [[nodiscard]] Result<std::string> front(std::size_t count) const;

 private:
  InputFile(int descriptor, std::uint64_t size) : descriptor_(descriptor), size_(size) {}

  int descriptor_;
  std::uint64_t size_;
};

/// The bytes of a file from `begin` to before `end`, or to the end of the file if that is earlier.
class FileSection final : public ByteStream {
 public:
  FileSection(std::shared_ptr<const InputFile> file, std::uint64_t begin, std::uint64_t end);

  [[nodiscard]] Result<std::size_t> read(std::span<char> into) override;
  std::uint64_t skip(std::uint64_t count) override;

 private:
  std::shared_ptr<const InputFile> file_;
  std::uint64_t position_;
  std::uint64_t end_;
};

/// A larger piece than this is not believed: 4096 x 4096 pixels of four bytes are 64 MB.
inline constexpr std::size_t kLargestPiece = 80'000'000;

/// Hands out pieces of a stream. The buffer grows with the largest piece and with nothing else.
class BufferedStream {
 public:
  /// `block`: how much is read at once.
  explicit BufferedStream(std::size_t block) : block_(block) {}

  /// Goes on with another stream, whose first byte is at `position`.
  void reset(std::unique_ptr<ByteStream> stream, std::uint64_t position = 0);

  /// Where the next piece begins.
  [[nodiscard]] std::uint64_t position() const { return position_; }

  [[nodiscard]] bool at_end();
  /// The next `count` bytes, valid until the next call; nothing, and a problem(), where there are fewer.
  [[nodiscard]] std::optional<std::string_view> take(std::uint64_t count);
  /// False, and a problem(), where there are fewer.
  [[nodiscard]] bool skip(std::uint64_t count);

  /// Why the stream ended where it should not; empty as long as it did not.
  [[nodiscard]] const std::string& problem() const { return problem_; }

 private:
  [[nodiscard]] bool fill(std::size_t count);
  [[nodiscard]] bool read_more();
  void fall_short(std::uint64_t count);

  std::size_t block_;
  std::unique_ptr<ByteStream> stream_;
  std::unique_ptr<char[]> buffer_;
  std::size_t capacity_ = 0;
  std::size_t begin_ = 0;
  std::size_t end_ = 0;
  std::uint64_t position_ = 0;
  std::string problem_;
};

}  // namespace waymark::bag
