#include "workbench/bags/decompress.hpp"

#include <algorithm>
#include <memory>
#include <string>
#include <utility>

#include <bzlib.h>
#include <fmt/format.h>
#include <lz4frame.h>
#include <zlib.h>
#include <zstd.h>

namespace waymark::bag {
namespace {

Error damaged(std::string_view compression, std::string_view why) {
  return {fmt::format("its {} data are damaged: {}", compression, why)};
}

/// What one call of a decompressor did.
struct Progress {
  std::size_t taken = 0;
  std::size_t made = 0;
  bool done = false;  ///< the frame is complete
};

/// As large as a block of LZ4 as rosbag writes it: what is there whole is not copied first.
constexpr std::size_t kBlock = 1 << 20;

/// A decompressor on top of a stream: feeds it block by block. `Codec` has a name and
/// `Result<Progress> run(packed, into)`.
template <class Codec>
class Decompressor final : public ByteStream {
 public:
  explicit Decompressor(std::unique_ptr<ByteStream> packed) : packed_(std::move(packed)) {}

  [[nodiscard]] Result<std::size_t> read(std::span<char> into) override {
    while (!done_) {
      const auto progress = codec_.run(input_, into);
      if (!progress) return progress.error();
      input_ = input_.subspan(progress->taken);
      done_ = progress->done;
      if (progress->made > 0) return progress->made;
      if (done_ || progress->taken > 0) continue;
      if (auto more = refill(); !more) return more.error();
    }
    return std::size_t{0};
  }

 private:
  Result<void> refill() {
    std::copy(input_.begin(), input_.end(), block_.get());
    const auto rest = std::span(block_.get(), kBlock).subspan(input_.size());
    const auto count = rest.empty() ? Result<std::size_t>(0) : packed_->read(rest);
    if (!count) return count.error();
    if (*count == 0) return Error{fmt::format("its {} data are cut off", Codec::kName)};
    input_ = std::span(block_.get(), kBlock).first(input_.size() + *count);
    return {};
  }

  std::unique_ptr<ByteStream> packed_;
  Codec codec_;
  std::unique_ptr<char[]> block_ = std::make_unique_for_overwrite<char[]>(kBlock);
  std::span<char> input_;
  bool done_ = false;
};

class Bz2 {
 public:
  static constexpr std::string_view kName = "bz2";
  Bz2() { BZ2_bzDecompressInit(&state_, 0, 0); }
  Bz2(const Bz2&) = delete;
  Bz2& operator=(const Bz2&) = delete;
  ~Bz2() { BZ2_bzDecompressEnd(&state_); }

  Result<Progress> run(std::span<char> packed, std::span<char> into) {
    state_.next_in = packed.data();
    state_.avail_in = static_cast<unsigned>(packed.size());
    state_.next_out = into.data();
    state_.avail_out = static_cast<unsigned>(into.size());
    const int status = BZ2_bzDecompress(&state_);
    if (status != BZ_OK && status != BZ_STREAM_END) return damaged(kName, fmt::format("error {}", status));
    return Progress{packed.size() - state_.avail_in, into.size() - state_.avail_out, status == BZ_STREAM_END};
  }

 private:
  bz_stream state_{};
};

class Lz4 {
 public:
  static constexpr std::string_view kName = "lz4";
  Lz4() { LZ4F_createDecompressionContext(&state_, LZ4F_VERSION); }
  Lz4(const Lz4&) = delete;
  Lz4& operator=(const Lz4&) = delete;
  ~Lz4() { LZ4F_freeDecompressionContext(state_); }

  Result<Progress> run(std::span<char> packed, std::span<char> into) {
    Progress progress{packed.size(), into.size()};
    const std::size_t status =
        LZ4F_decompress(state_, into.data(), &progress.made, packed.data(), &progress.taken, nullptr);
    if (LZ4F_isError(status) != 0) return damaged(kName, LZ4F_getErrorName(status));
    // The same 0 stands for "complete" and, where nothing went in, for "nothing to do".
    progress.done = status == 0 && !packed.empty();
    return progress;
  }

 private:
  LZ4F_dctx* state_ = nullptr;
};

class Zstd {
 public:
  static constexpr std::string_view kName = "zstd";
  Zstd() : state_(ZSTD_createDCtx()) {}
  Zstd(const Zstd&) = delete;
  Zstd& operator=(const Zstd&) = delete;
  ~Zstd() { ZSTD_freeDCtx(state_); }

  Result<Progress> run(std::span<char> packed, std::span<char> into) {
    ZSTD_inBuffer in{packed.data(), packed.size(), 0};
    ZSTD_outBuffer out{into.data(), into.size(), 0};
    const std::size_t status = ZSTD_decompressStream(state_, &out, &in);
    if (ZSTD_isError(status) != 0) return damaged(kName, ZSTD_getErrorName(status));
    return Progress{in.pos, out.pos, status == 0 && !packed.empty()};
  }

 private:
  ZSTD_DCtx* state_;
};

class Checked final : public ByteStream {
 public:
  Checked(std::unique_ptr<ByteStream> stream, std::uint64_t size, std::optional<std::uint32_t> crc32)
      : stream_(std::move(stream)), size_(size), left_(size), expected_(crc32) {}

  [[nodiscard]] Result<std::size_t> read(std::span<char> into) override {
    if (left_ == 0) return check_end();
    const auto most = static_cast<std::size_t>(std::min<std::uint64_t>(left_, into.size()));
    auto count = stream_->read(into.first(most));
    if (!count) return count;
    if (*count == 0) return Error{fmt::format("it has {} bytes less than the {} stated", left_, size_)};
    left_ -= *count;
    if (expected_) crc_ = crc32_z(crc_, reinterpret_cast<const Bytef*>(into.data()), *count);
    return count;
  }

  std::uint64_t skip(std::uint64_t count) override {
    if (expected_) return 0;
    const std::uint64_t skipped = stream_->skip(std::min(count, left_));
    left_ -= skipped;
    return skipped;
  }

 private:
  Result<std::size_t> check_end() {
    char more = 0;
    auto count = stream_->read({&more, 1});
    if (!count) return count;
    if (*count > 0) return Error{fmt::format("it has more than the {} bytes stated", size_)};
    if (expected_ && crc_ != *expected_) return Error{"its checksum is wrong, so its content may be damaged"};
    return std::size_t{0};
  }

  std::unique_ptr<ByteStream> stream_;
  std::uint64_t size_;
  std::uint64_t left_;
  std::optional<std::uint32_t> expected_;
  uLong crc_ = 0;
};

}  // namespace

std::unique_ptr<ByteStream> decompressed(std::string_view compression, std::unique_ptr<ByteStream> packed) {
  if (compression == "none" || compression.empty()) return packed;
  if (compression == Bz2::kName) return std::make_unique<Decompressor<Bz2>>(std::move(packed));
  if (compression == Lz4::kName) return std::make_unique<Decompressor<Lz4>>(std::move(packed));
  if (compression == Zstd::kName) return std::make_unique<Decompressor<Zstd>>(std::move(packed));
  return nullptr;
}

std::unique_ptr<ByteStream> checked(std::unique_ptr<ByteStream> stream, std::uint64_t size,
                                    std::optional<std::uint32_t> crc32) {
  return std::make_unique<Checked>(std::move(stream), size, crc32);
}

}  // namespace waymark::bag
