#pragma once

#include <vector>

#include "waymark/core/random.hpp"

namespace waymark::sim {

/// A place on a canvas, in texels: columns from the left, rows from above.
struct Area {
  int left = 0;
  int top = 0;
  int width = 0;
  int height = 0;
};

/// A texture while it is painted: grey values 0 to 255 on a grid whose sides are powers of two and which
/// repeats, so that what is painted across one side goes on at the other.
class Canvas {
 public:
  Canvas(int log2_width, int log2_height, float grey);

  [[nodiscard]] int log2_width() const { return log2_width_; }
  [[nodiscard]] int log2_height() const { return log2_height_; }
  [[nodiscard]] int width() const { return 1 << log2_width_; }
  [[nodiscard]] int height() const { return 1 << log2_height_; }
  [[nodiscard]] Area whole() const { return {0, 0, width(), height()}; }

  float& at(int column, int row) { return grey_[place(column, row)]; }
  [[nodiscard]] float at(int column, int row) const { return grey_[place(column, row)]; }

  void fill(const Area& area, float grey);
  void brighten(const Area& area, float by);
  void disc(float column, float row, float radius, float grey);

  /// Adds smooth noise, up to +-amplitude, with grains of the given size (powers of two).
  void add_grain(int grain_width, int grain_height, float amplitude, RandomStream& random);

 private:
  [[nodiscard]] std::size_t place(int column, int row) const {
    const auto u = static_cast<std::size_t>(column & (width() - 1));
    return (static_cast<std::size_t>(row & (height() - 1)) << log2_width_) + u;
  }

  int log2_width_;
  int log2_height_;
  std::vector<float> grey_;
};

}  // namespace waymark::sim
