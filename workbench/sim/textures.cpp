#include "workbench/sim/textures.hpp"

#include <algorithm>
#include <cmath>

namespace waymark::sim {
namespace {

float draw(RandomStream& random, double low, double high) {
  return static_cast<float>(random.uniform(low, high));
}

int draw_int(RandomStream& random, int low, int high) {
  return low + static_cast<int>(random.uniform() * (high - low + 1));
}

/// Dark or light ink that stands out from the middle greys.
float draw_ink(RandomStream& random) {
  return random.uniform() < 0.5 ? draw(random, 5.0, 60.0) : draw(random, 190.0, 250.0);
}

Area draw_inside(const Area& frame, int width, int height, RandomStream& random) {
  const int room_right = std::max(0, frame.width - width);
  const int room_below = std::max(0, frame.height - height);
  const int left = frame.left + draw_int(random, 0, room_right);
  return {left, frame.top + draw_int(random, 0, room_below), width, height};
}

// Grains of all sizes, so that there is something to see from near and far.
void add_plaster(Canvas& canvas, float amplitude, RandomStream& random) {
  for (const int grain : {2, 4, 16, 64}) canvas.add_grain(grain, grain, amplitude, random);
}

void lay_bricks(Canvas& canvas, const Area& wall, RandomStream& random) {
  constexpr int kWidth = 48;
  constexpr int kHeight = 16;
  constexpr int kJoint = 2;
  canvas.brighten(wall, 45.0F);
  for (int row = 0; row * kHeight < wall.height; ++row) {
    for (int left = row % 2 * kWidth / 2; left + kWidth <= wall.width; left += kWidth)
      canvas.fill({wall.left + left, wall.top + row * kHeight, kWidth - kJoint, kHeight - kJoint},
                  draw(random, 60.0, 130.0));
  }
}

void print_blocks(Canvas& canvas, const Area& poster, RandomStream& random) {
  const int cell = draw_int(random, 8, 16);
  for (int y = 0; y + cell <= poster.height; y += cell)
    for (int x = 0; x + cell <= poster.width; x += cell)
      if (random.uniform() < 0.5)
        canvas.fill({poster.left + x, poster.top + y, cell, cell}, draw(random, 5.0, 70.0));
}

void print_lines_of_text(Canvas& canvas, const Area& poster, RandomStream& random) {
  const int height = draw_int(random, 4, 8);
  for (int y = height; y + height <= poster.height; y += 2 * height) {
    for (int x = height; x + 4 * height <= poster.width;) {
      const int length = draw_int(random, 1, 4) * height;
      canvas.fill({poster.left + x, poster.top + y, length, height}, draw(random, 5.0, 60.0));
      x += length + height;
    }
  }
}

void print_shapes(Canvas& canvas, const Area& poster, RandomStream& random) {
  for (int i = 0; i < 14; ++i) {
    const int size = draw_int(random, 10, std::max(12, poster.width / 3));
    const Area box = draw_inside(poster, size, draw_int(random, 8, size), random);
    if (random.uniform() < 0.6)
      canvas.fill(box, draw_ink(random));
    else
      canvas.disc(static_cast<float>(box.left) + 0.5F * static_cast<float>(size),
                  static_cast<float>(box.top) + 0.5F * static_cast<float>(box.height),
                  0.5F * static_cast<float>(box.height), draw_ink(random));
  }
}

void hang_poster(Canvas& canvas, const Area& place, RandomStream& random) {
  canvas.fill(place, draw(random, 20.0, 60.0));
  const Area paper{place.left + 4, place.top + 4, place.width - 8, place.height - 8};
  canvas.fill(paper, draw(random, 180.0, 230.0));
  switch (draw_int(random, 0, 2)) {
    case 0:
      return print_blocks(canvas, paper, random);
    case 1:
      return print_lines_of_text(canvas, paper, random);
    default:
      return print_shapes(canvas, paper, random);
  }
}

void draw_joints(Canvas& canvas, int spacing, int width, float grey) {
  for (int x = 0; x < canvas.width(); x += spacing) canvas.fill({x, 0, width, canvas.height()}, grey);
  for (int y = 0; y < canvas.height(); y += spacing) canvas.fill({0, y, canvas.width(), width}, grey);
}

void lay_tiles(Canvas& canvas, int side, double darkest, double lightest, RandomStream& random) {
  for (int y = 0; y < canvas.height(); y += side)
    for (int x = 0; x < canvas.width(); x += side)
      canvas.fill({x, y, side, side}, draw(random, darkest, lightest));
}

void scatter(Canvas& canvas, int count, int size_min, int size_max, RandomStream& random) {
  for (int i = 0; i < count; ++i) {
    const int width = draw_int(random, size_min, size_max);
    canvas.fill(draw_inside(canvas.whole(), width, draw_int(random, size_min, size_max), random),
                draw_ink(random));
  }
}

}  // namespace

Canvas paint_wall(double length_m, RandomStream& random) {
  const int log2_width = std::clamp(static_cast<int>(std::ceil(std::log2(length_m / kTexel_m))), 9, 12);
  Canvas canvas(log2_width, 9, draw(random, 110.0, 150.0));
  const int parts = canvas.width() / 128;
  for (int i = 0; i < parts; i += 5)
    lay_bricks(canvas,
               draw_inside(canvas.whole(), draw_int(random, 200, 480), draw_int(random, 160, 512), random),
               random);
  scatter(canvas, 4 * parts, 4, 24, random);
  for (int i = 0; i < parts; ++i) {
    const int width = draw_int(random, 60, 160);
    const int height = draw_int(random, 60, 180);
    hang_poster(canvas, draw_inside({i * 128, 20, 128, 440}, width, height, random), random);
  }
  add_plaster(canvas, 7.0F, random);
  return canvas;
}

Canvas paint_floor(RandomStream& random) {
  Canvas canvas(10, 10, 100.0F);
  lay_tiles(canvas, 64, 80.0, 120.0, random);
  draw_joints(canvas, 64, 2, 60.0F);
  scatter(canvas, 250, 3, 14, random);
  add_plaster(canvas, 8.0F, random);
  return canvas;
}

Canvas paint_ceiling(RandomStream& random) {
  Canvas canvas(10, 10, 170.0F);
  lay_tiles(canvas, 128, 150.0, 190.0, random);
  draw_joints(canvas, 128, 4, 90.0F);
  scatter(canvas, 120, 4, 20, random);
  add_plaster(canvas, 6.0F, random);
  return canvas;
}

Canvas paint_furniture(RandomStream& random) {
  Canvas canvas(8, 8, draw(random, 80.0, 170.0));
  canvas.add_grain(64, 4, 14.0F, random);
  draw_joints(canvas, draw_int(random, 0, 1) == 0 ? 64 : 128, 3, draw(random, 20.0, 60.0));
  scatter(canvas, 40, 4, 30, random);
  hang_poster(canvas, draw_inside(canvas.whole(), 80, 70, random), random);
  add_plaster(canvas, 5.0F, random);
  return canvas;
}

Canvas paint_clothes(RandomStream& random) {
  Canvas canvas(8, 8, draw(random, 60.0, 190.0));
  const int stripe = draw_int(random, 6, 20);
  const float ink = draw_ink(random);
  for (int y = 0; y < canvas.height(); y += 2 * stripe) canvas.fill({0, y, canvas.width(), stripe}, ink);
  scatter(canvas, 60, 4, 16, random);
  add_plaster(canvas, 6.0F, random);
  return canvas;
}

}  // namespace waymark::sim
