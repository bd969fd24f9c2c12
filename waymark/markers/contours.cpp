#include "waymark/markers/contours.hpp"

#include <array>
#include <cstring>

namespace waymark::markers {
namespace {

/// A step to the next pixel.
struct Step {
  int u = 0;
  int v = 0;
};

// Up, right, down, left; a quarter turn to the right is the next.
constexpr std::array<Step, 4> kSteps{Step{0, -1}, Step{1, 0}, Step{0, 1}, Step{-1, 0}};
constexpr unsigned kUp = 0;
constexpr unsigned kRight = 1;
constexpr unsigned kLeft = 3;

constexpr unsigned turned(unsigned direction, unsigned by) { return (direction + by) % 4; }

/// Between a bright pixel on the left and a dark one on the right of who walks along a contour.
struct Crossing {
  int u = 0;  ///< of the bright pixel
  int v = 0;
  unsigned direction = kUp;
  const std::int16_t* bright = nullptr;

  friend bool operator==(const Crossing&, const Crossing&) = default;
};

class Walker {
 public:
  explicit Walker(const ContrastMap& map) {
    for (unsigned i = 0; i < 4; ++i) offsets_[i] = kSteps[i].u + kSteps[i].v * map.stride();
  }

  [[nodiscard]] Eigen::Vector2f point(const Crossing& at) const {
    const auto bright = static_cast<float>(*at.bright);
    const auto dark = static_cast<float>(at.bright[offsets_[turned(at.direction, kRight)]]);
    const float part = bright / (bright - dark);
    const Step& across = kSteps[turned(at.direction, kRight)];
    return {static_cast<float>(at.u) + part * static_cast<float>(across.u),
            static_cast<float>(at.v) + part * static_cast<float>(across.v)};
  }

  /// Through the square of pixels ahead: straight on where its far corners are as the near ones, else around
  /// the dark or the bright pixel.
  [[nodiscard]] Crossing next(const Crossing& at) const {
    const std::ptrdiff_t ahead = offsets_[at.direction], right = offsets_[turned(at.direction, kRight)];
    const int far_left = at.bright[ahead], far_right = at.bright[ahead + right];
    const bool is_joined =
        far_left < 0 && (far_right < 0 || *at.bright + at.bright[right] + far_left + far_right < 0);
    if (is_joined) return {at.u, at.v, turned(at.direction, kLeft), at.bright};
    const Crossing straight = moved(at, at.direction);
    if (far_right < 0) return straight;
    Crossing around = moved(straight, turned(at.direction, kRight));
    around.direction = turned(at.direction, kRight);
    return around;
  }

 private:
  [[nodiscard]] Crossing moved(const Crossing& at, unsigned direction) const {
    return {at.u + kSteps[direction].u, at.v + kSteps[direction].v, at.direction,
            at.bright + offsets_[direction]};
  }

  std::array<std::ptrdiff_t, 4> offsets_{};
};

}  // namespace

void ContourTracer::trace(const ContrastMap& map, std::size_t points_min,
                          const std::function<void(const Contour&)>& use) {
  is_done_.assign(map.values.size(), 0);
  // A word beyond the row's end is looked at.
  starts_.assign(static_cast<std::size_t>(map.stride()) + sizeof(std::uint64_t), 0);
  for (int v = 0; v < map.height_px; ++v) {
    find_starts(map, v);
    for (int u = -1; u < map.width_px; ++u) {
      std::uint64_t eight = 0;
      std::memcpy(&eight, starts_.data() + u + 1, sizeof eight);
      if (eight == 0) {
        u += static_cast<int>(sizeof eight) - 1;
        continue;
      }
      if (starts_[static_cast<std::size_t>(u + 1)] == 0 ||
          is_done_[static_cast<std::size_t>(map.row(v) + u - map.values.data())] != 0)
        continue;
      follow(map, u, v);
      if (contour_.size() >= points_min) use(contour_);
    }
  }
}

void ContourTracer::find_starts(const ContrastMap& map, int v) {
  const std::int16_t* row = map.row(v) - 1;
  for (int i = 0; i <= map.width_px; ++i)
    starts_[static_cast<std::size_t>(i)] = static_cast<std::uint8_t>((row[i] >= 0) & (row[i + 1] < 0));
}

void ContourTracer::follow(const ContrastMap& map, int u, int v) {
  const Walker walker(map);
  const Crossing start{u, v, kUp, map.row(v) + u};
  contour_.clear();
  Crossing at = start;
  do {
    if (at.direction == kUp) is_done_[static_cast<std::size_t>(at.bright - map.values.data())] = 1;
    contour_.push_back(walker.point(at));
    at = walker.next(at);
  } while (at != start);
}

}  // namespace waymark::markers
