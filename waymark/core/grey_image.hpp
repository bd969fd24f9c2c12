#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace waymark {

/// A view of 8-bit grey pixels that are owned elsewhere: row v begins at data + v * stride. Origin at the
/// centre of the first pixel, u right, v down.
struct ImageView {
  const std::uint8_t* data = nullptr;
  int width_px = 0;
  int height_px = 0;
  std::ptrdiff_t stride = 0;  ///< bytes from one row to the next

  [[nodiscard]] const std::uint8_t* row(int v) const { return data + v * stride; }
  [[nodiscard]] const std::uint8_t* pixel(int u, int v) const { return row(v) + u; }
  [[nodiscard]] std::uint8_t operator()(int u, int v) const { return *pixel(u, v); }
  [[nodiscard]] bool empty() const { return width_px <= 0 || height_px <= 0; }

  /// The rectangle of `width_px` x `height_px` pixels from (u, v), which must lie inside.
  [[nodiscard]] ImageView part(int u, int v, int part_width_px, int part_height_px) const {
    return {pixel(u, v), part_width_px, part_height_px, stride};
  }
};

/// An 8-bit grey image that owns its pixels, row after row without gaps.
class GreyImage {
 public:
  GreyImage() = default;
  GreyImage(int width_px, int height_px, std::uint8_t grey = 0)
      : width_px_(width_px),
        height_px_(height_px),
        pixels_(static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px), grey) {}

  [[nodiscard]] int width_px() const { return width_px_; }
  [[nodiscard]] int height_px() const { return height_px_; }
  [[nodiscard]] std::ptrdiff_t stride() const { return width_px_; }
  [[nodiscard]] std::uint8_t* data() { return pixels_.data(); }
  [[nodiscard]] const std::uint8_t* data() const { return pixels_.data(); }
  std::uint8_t& operator()(int u, int v) { return pixels_[place(u, v)]; }
  std::uint8_t operator()(int u, int v) const { return pixels_[place(u, v)]; }

  [[nodiscard]] ImageView view() const { return {data(), width_px_, height_px_, stride()}; }
  // NOLINTNEXTLINE(google-explicit-constructor): an image can be looked at
  operator ImageView() const { return view(); }

  friend bool operator==(const GreyImage&, const GreyImage&) = default;

 private:
  [[nodiscard]] std::size_t place(int u, int v) const {
    return static_cast<std::size_t>(v) * static_cast<std::size_t>(width_px_) + static_cast<std::size_t>(u);
  }

  int width_px_ = 0;
  int height_px_ = 0;
  std::vector<std::uint8_t> pixels_;
};

}  // namespace waymark
