#include "workbench/logs/deep_image.hpp"

#include <algorithm>
#include <csetjmp>
#include <cstddef>
#include <string>

#include <png.h>

namespace waymark {
namespace {

/// libpng's full interface, which does nothing to the values. Frees what it holds, whatever way a function is
/// left; libpng reports errors by a call that must not return.
class DeepPng {
 public:
  explicit DeepPng(std::string_view bytes) : rest_(bytes) {}
  DeepPng(const DeepPng&) = delete;
  DeepPng& operator=(const DeepPng&) = delete;
  ~DeepPng() { png_destroy_read_struct(&png_, &info_, nullptr); }

  // In both functions nothing that needs destruction lives when libpng jumps out.
  bool read_header() {
    if (setjmp(leave_) != 0) return false;
    png_ = png_create_read_struct(PNG_LIBPNG_VER_STRING, this, fail, [](png_structp, png_const_charp) {});
    info_ = png_ == nullptr ? nullptr : png_create_info_struct(png_);
    if (info_ == nullptr) return false;
    png_set_read_fn(png_, this, take);
    png_read_info(png_, info_);
    png_set_expand_16(png_);
    png_set_interlace_handling(png_);
    png_read_update_info(png_, info_);
    return true;
  }
  bool read_rows(png_bytep* rows) {
    if (setjmp(leave_) != 0) return false;
    png_read_image(png_, rows);
    png_read_end(png_, nullptr);
    return true;
  }

  [[nodiscard]] std::size_t width() const { return png_get_image_width(png_, info_); }
  [[nodiscard]] std::size_t height() const { return png_get_image_height(png_, info_); }
  [[nodiscard]] std::size_t channels() const { return png_get_channels(png_, info_); }
  [[nodiscard]] std::size_t row_bytes() const { return png_get_rowbytes(png_, info_); }
  [[nodiscard]] const std::string& problem() const { return problem_; }

 private:
  [[noreturn]] static void fail(png_structp png, png_const_charp text) {
    auto* self = static_cast<DeepPng*>(png_get_error_ptr(png));
    self->problem_ = text;
    std::longjmp(self->leave_, 1);
  }

  static void take(png_structp png, png_bytep to, std::size_t count) {
    auto* self = static_cast<DeepPng*>(png_get_io_ptr(png));
    if (count > self->rest_.size()) png_error(png, "it is cut off");
    std::copy_n(self->rest_.data(), count, to);
    self->rest_.remove_prefix(count);
  }

  std::string_view rest_;
  std::jmp_buf leave_{};
  png_structp png_ = nullptr;
  png_infop info_ = nullptr;
  std::string problem_ = "there is no memory for it";
};

/// PNG keeps the upper byte first.
std::uint32_t png_sample(const png_byte* bytes) { return 256U * bytes[0] + bytes[1]; }

/// Of a pixel with one to four channels: grey or colours, with or without opacity.
std::uint16_t deep_grey(const png_byte* pixel, std::size_t channels) {
  std::uint32_t grey = png_sample(pixel);
  if (channels >= 3)
    grey = (299 * grey + 587 * png_sample(pixel + 2) + 114 * png_sample(pixel + 4) + 500) / 1000;
  if (channels % 2 == 0) grey = grey * png_sample(pixel + 2 * (channels - 1)) / 65535;
  return static_cast<std::uint16_t>(grey);
}

}  // namespace

Result<DeepImage> decode_deep_png(std::string_view bytes) {
  DeepPng png(bytes);
  if (!png.read_header()) return Error{png.problem()};
  std::vector<png_byte> stored(png.row_bytes() * png.height());
  std::vector<png_bytep> rows(png.height());
  for (std::size_t v = 0; v < rows.size(); ++v) rows[v] = stored.data() + v * png.row_bytes();
  if (!png.read_rows(rows.data())) return Error{png.problem()};
  DeepImage image{static_cast<int>(png.width()), static_cast<int>(png.height()), {}};
  image.values.reserve(png.width() * png.height());
  for (const png_byte* row : rows)
    for (std::size_t u = 0; u < png.width(); ++u)
      image.values.push_back(deep_grey(row + 2 * png.channels() * u, png.channels()));
  return image;
}

GreyImage to_grey(const DeepImage& image, UsedBits& bits) {
  GreyImage grey(image.width_px, image.height_px);
  const int shift = bits.shift(image.values.empty() ? 0 : *std::ranges::max_element(image.values));
  std::ranges::transform(image.values, grey.data(),
                         [shift](std::uint16_t value) { return static_cast<std::uint8_t>(value >> shift); });
  return grey;
}

}  // namespace waymark
