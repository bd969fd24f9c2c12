#include "workbench/logs/tum.hpp"

#include <cerrno>
#include <cmath>
#include <system_error>
#include <utility>

#include "workbench/logs/number_text.hpp"

namespace waymark {
namespace {

constexpr std::size_t kBufferBytes = 1 << 16;
constexpr std::size_t kLongestRow = 2048;

}  // namespace

Result<TumWriter> TumWriter::open(const std::filesystem::path& path) {
  errno = 0;
  std::ofstream file(path, std::ios::binary);
  if (!file) return Error{"cannot write " + path.string() + ": " + std::generic_category().message(errno)};
  return TumWriter(path, std::move(file));
}

TumWriter::TumWriter(std::filesystem::path path, std::ofstream file)
    : path_(std::move(path)), file_(std::move(file)) {
  buffer_.reserve(kBufferBytes);
}

TumWriter::~TumWriter() { flush(); }

void TumWriter::write(Stamp stamp, const Pose2& pose) {
  append_stamp(buffer_, stamp);
  append_fixed(buffer_ += ' ', pose.x_m);
  append_fixed(buffer_ += ' ', pose.y_m);
  buffer_ += " 0 0 0";
  append_fixed(buffer_ += ' ', std::sin(0.5 * pose.theta_rad));
  append_fixed(buffer_ += ' ', std::cos(0.5 * pose.theta_rad));
  buffer_ += '\n';
  if (buffer_.size() + kLongestRow > kBufferBytes) flush();
}

void TumWriter::flush() {
  if (!file_.is_open()) return;
  file_.write(buffer_.data(), static_cast<std::streamsize>(buffer_.size()));
  file_.flush();
  buffer_.clear();
}

Result<void> TumWriter::close() {
  flush();
  file_.close();
  if (file_) return {};
  return Error{"cannot write " + path_.string() + ": is the disk full?", Error::Kind::kFailed};
}

}  // namespace waymark
