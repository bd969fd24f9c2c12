#include "workbench/bags/byte_stream.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "workbench/config/read_file.hpp"

namespace waymark::bag {
namespace {

Error system_error(const std::string& what) { return {what + ": " + std::generic_category().message(errno)}; }

}  // namespace

Result<std::shared_ptr<const InputFile>> InputFile::open(const std::filesystem::path& path) {
  if (auto checked = check_is_file(path); !checked) return checked.error();
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return system_error("cannot read " + path.string());
  struct stat status = {};
  if (::fstat(descriptor, &status) != 0) {
    const Error error = system_error("cannot read " + path.string());
    ::close(descriptor);
    return error;
  }
  return std::shared_ptr<const InputFile>(
      new InputFile(descriptor, static_cast<std::uint64_t>(status.st_size)));
}

InputFile::~InputFile() { ::close(descriptor_); }

Result<std::size_t> InputFile::read(std::uint64_t position, std::span<char> into) const {
  while (true) {
    const ssize_t count = ::pread(descriptor_, into.data(), into.size(), static_cast<off_t>(position));
    if (count >= 0) return static_cast<std::size_t>(count);
    if (errno != EINTR) return system_error("cannot be read");
  }
}

Result<std::string> InputFile::front(std::size_t count) const {
  std::string bytes(count, '\0');
  if (const auto done = read(0, bytes); !done) return done.error();
  return bytes;
}

FileSection::FileSection(std::shared_ptr<const InputFile> file, std::uint64_t begin, std::uint64_t end)
    : file_(std::move(file)), position_(begin), end_(std::max(begin, std::min(end, file_->size()))) {}

Result<std::size_t> FileSection::read(std::span<char> into) {
  const auto count = static_cast<std::size_t>(std::min<std::uint64_t>(into.size(), end_ - position_));
  if (count == 0) return count;
  auto done = file_->read(position_, into.first(count));
  if (done) position_ += *done;
  return done;
}

std::uint64_t FileSection::skip(std::uint64_t count) {
  const std::uint64_t skipped = std::min(count, end_ - position_);
  position_ += skipped;
  return skipped;
}

void BufferedStream::reset(std::unique_ptr<ByteStream> stream, std::uint64_t position) {
  stream_ = std::move(stream);
  begin_ = end_ = 0;
  position_ = position;
  problem_.clear();
}

bool BufferedStream::at_end() { return begin_ == end_ && !fill(1); }

std::optional<std::string_view> BufferedStream::take(std::uint64_t count) {
  if (end_ - begin_ < count) {
    if (count > kLargestPiece) {
      problem_ = fmt::format("a piece of {} bytes, but at most {} are plausible", count, kLargestPiece);
      return std::nullopt;
    }
    if (!fill(static_cast<std::size_t>(count))) {
      fall_short(count);
      return std::nullopt;
    }
  }
  const std::string_view piece(buffer_.get() + begin_, static_cast<std::size_t>(count));
  begin_ += piece.size();
  position_ += piece.size();
  return piece;
}

bool BufferedStream::skip(std::uint64_t count) {
  std::uint64_t left = count;
  while (left > 0) {
    const std::uint64_t buffered = std::min<std::uint64_t>(left, end_ - begin_);
    begin_ += static_cast<std::size_t>(buffered);
    const std::uint64_t passed =
        buffered > 0 || left <= block_ || stream_ == nullptr ? buffered : stream_->skip(left);
    position_ += passed;
    left -= passed;
    if (passed == 0 && !fill(1)) {
      fall_short(left);
      return false;
    }
  }
  return true;
}

bool BufferedStream::fill(std::size_t count) {
  if (begin_ > 0) {
    std::memmove(buffer_.get(), buffer_.get() + begin_, end_ - begin_);
    end_ -= begin_;
    begin_ = 0;
  }
  if (capacity_ < count || capacity_ == 0) {
    const std::size_t capacity = std::max(count, block_);
    auto buffer = std::make_unique_for_overwrite<char[]>(capacity);
    std::copy_n(buffer_.get(), end_, buffer.get());
    buffer_ = std::move(buffer);
    capacity_ = capacity;
  }
  while (end_ < count)
    if (!read_more()) return false;
  return true;
}

bool BufferedStream::read_more() {
  if (stream_ == nullptr) return false;
  const auto count = stream_->read({buffer_.get() + end_, capacity_ - end_});
  if (!count) problem_ = count.error().message;
  if (!count || *count == 0) {
    stream_.reset();
    return false;
  }
  end_ += *count;
  return true;
}

void BufferedStream::fall_short(std::uint64_t count) {
  if (problem_.empty())
    problem_ = fmt::format("it ends where {} more bytes should be", count - (end_ - begin_));
}

}  // namespace waymark::bag
