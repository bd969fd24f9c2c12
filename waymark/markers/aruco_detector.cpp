#include "waymark/markers/aruco_detector.hpp"

#include <algorithm>
#include <tuple>

#include "waymark/markers/cell_reading.hpp"
#include "waymark/markers/code_book.hpp"
#include "waymark/markers/quad_finder.hpp"

namespace waymark::markers {
namespace {

// Part of a border's cells that may not be black: hidden, in glare, or blended with their neighbours.
constexpr double kWrongBorderMax = 0.35;
// Part of all cells that may be of two colours: a pattern of other cells, read by chance, has more.
constexpr double kDividedMax = 0.25;
// Smaller images have no room for a marker and paper around it.
constexpr int kImageMin_px = 8;

/// Corners from the upper left of the pattern, which is `turns` quarters counter-clockwise from the first.
Corners turned(const Corners& corners, int turns) {
  Corners from_pattern = corners;
  std::ranges::rotate(from_pattern, from_pattern.end() - turns);
  return from_pattern;
}

/// The same identity at the same place.
bool are_one(const Marker& a, const Marker& b) {
  const double diagonal_px = (a.corners_px[2] - a.corners_px[0]).norm();
  return a.id == b.id && (a.corners_px[0] - b.corners_px[0]).norm() < diagonal_px;
}

class ArucoDetector final : public MarkerDetector {
 public:
  explicit ArucoDetector(const MarkerDictionary& dictionary)
      : bits_per_side_(dictionary.bits_per_side), code_book_(dictionary) {}

  std::vector<Marker> detect(const ImageView& image) override {
    if (std::min(image.width_px, image.height_px) < kImageMin_px) return {};
    std::vector<Marker> found;
    for (const Corners& quad : finder_.find(image)) {
      const auto marker = read(image, quad);
      if (marker && std::ranges::none_of(found, [&](const Marker& each) { return are_one(each, *marker); }))
        found.push_back(*marker);
    }
    std::ranges::sort(found, {}, [](const Marker& each) {
      return std::tuple(each.id, each.corners_px[0].x(), each.corners_px[0].y());
    });
    return found;
  }

 private:
  [[nodiscard]] bool is_marker(const CellReading& cells) const {
    const int side = bits_per_side_ + 2, border = 4 * (side - 1);
    return cells.wrong_border <= kWrongBorderMax * border && cells.divided <= kDividedMax * side * side;
  }

  [[nodiscard]] std::optional<Marker> read(const ImageView& image, const Corners& quad) const {
    const auto cells = read_cells(image, quad, bits_per_side_);
    if (!cells || !is_marker(*cells)) return std::nullopt;
    const auto code = code_book_.find(cells->bits);
    return code ? std::optional(Marker{code->id, turned(quad, code->turns)}) : std::nullopt;
  }

  int bits_per_side_;
  CodeBook code_book_;
  QuadFinder finder_;
};

}  // namespace

std::unique_ptr<MarkerDetector> make_aruco_detector(const MarkerDictionary& dictionary) {
  return std::make_unique<ArucoDetector>(dictionary);
}

}  // namespace waymark::markers
