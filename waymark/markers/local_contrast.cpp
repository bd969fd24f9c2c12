#include "waymark/markers/local_contrast.hpp"

#include <algorithm>
#include <limits>

namespace waymark::markers {
namespace {

constexpr int kWindowMax_px = 9;
static_assert(kWindowMax_px * kWindowMax_px * (255 + 99) <= std::numeric_limits<std::int16_t>::max());

/// Sums over the window's height, half a window more of columns to either side.
class ColumnSums {
 public:
  ColumnSums(const ImageView& image, int window_px)
      : image_(image),
        half_px_(window_px / 2),
        sums_(static_cast<std::size_t>(image.width_px + 2 * half_px_)) {
    for (int v = -half_px_; v <= half_px_; ++v) add(row(v));
    repeat_ends();
  }

  /// From the window about row v to that about the next.
  void step_from(int v) {
    const std::uint8_t* next = row(v + half_px_ + 1);
    const std::uint8_t* last = row(v - half_px_);
    std::uint16_t* sums = sums_.data() + half_px_;
    for (int u = 0; u < image_.width_px; ++u)
      sums[u] = static_cast<std::uint16_t>(sums[u] + next[u] - last[u]);
    repeat_ends();
  }

  [[nodiscard]] const std::uint16_t* data() const { return sums_.data(); }

 private:
  [[nodiscard]] const std::uint8_t* row(int v) const {
    return image_.row(std::clamp(v, 0, image_.height_px - 1));
  }
  void add(const std::uint8_t* row) {
    std::uint16_t* sums = sums_.data() + half_px_;
    for (int u = 0; u < image_.width_px; ++u) sums[u] = static_cast<std::uint16_t>(sums[u] + row[u]);
  }
  void repeat_ends() {
    std::fill_n(sums_.begin(), half_px_, *(sums_.begin() + half_px_));
    std::fill_n(sums_.end() - half_px_, half_px_, *(sums_.end() - half_px_ - 1));
  }

  ImageView image_;
  int half_px_;
  std::vector<std::uint16_t> sums_;
};

/// 16 bits throughout and a window that the compiler knows, so that eight pixels are one instruction.
template <int window_px>
void compare_row(const std::uint8_t* grey, const std::uint16_t* sums, int width_px, int margin_grey,
                 std::int16_t* values) {
  for (int u = 0; u < width_px; ++u) {
    std::uint16_t sum = 0;
    for (int i = 0; i < window_px; ++i) sum = static_cast<std::uint16_t>(sum + sums[u + i]);
    values[u] = static_cast<std::int16_t>(window_px * window_px * (grey[u] + margin_grey) - sum);
  }
}

using CompareRow = decltype(&compare_row<kWindowMax_px>);

CompareRow comparison(int window_px) {
  switch (window_px) {
    case 3:
      return compare_row<3>;
    case 5:
      return compare_row<5>;
    case 7:
      return compare_row<7>;
    default:
      return compare_row<kWindowMax_px>;
  }
}

void frame(ContrastMap& map) {
  constexpr std::int16_t kBright = std::numeric_limits<std::int16_t>::max();
  std::fill_n(map.row(-1) - 1, map.stride(), kBright);
  std::fill_n(map.row(map.height_px) - 1, map.stride(), kBright);
  for (int v = 0; v < map.height_px; ++v) map.row(v)[-1] = map.row(v)[map.width_px] = kBright;
}

}  // namespace

void measure_contrast(const ImageView& image, const Darkness& darkness, ContrastMap& map) {
  map.width_px = image.width_px;
  map.height_px = image.height_px;
  map.values.resize(static_cast<std::size_t>(map.stride() * (image.height_px + 2)));
  frame(map);
  ColumnSums sums(image, darkness.window_px);
  const CompareRow compare = comparison(darkness.window_px);
  for (int v = 0; v < image.height_px; ++v) {
    compare(image.row(v), sums.data(), image.width_px, darkness.margin_grey, map.row(v));
    sums.step_from(v);
  }
}

}  // namespace waymark::markers
