#include "workbench/calibrate/opencv/board_finders.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <opencv2/aruco/charuco.hpp>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

namespace waymark::calibrate::opencv {
namespace {

using Points = std::vector<cv::Point2f>;

/// OpenCV has no view of what must not be written to, but finding does not write.
cv::Mat pixels_of(const ImageView& image) {
  return {image.height_px, image.width_px, CV_8UC1, const_cast<std::uint8_t*>(image.data),
          static_cast<std::size_t>(image.stride)};
}

/// From each corner to its nearest neighbour in a row or column, px.
double nearest_px(const Points& points, const std::vector<int>& indices, GridSize grid, std::size_t which) {
  double nearest = std::numeric_limits<double>::infinity();
  const int column = indices[which] % grid.columns, row = indices[which] / grid.columns;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (std::abs(indices[i] % grid.columns - column) + std::abs(indices[i] / grid.columns - row) == 1)
      nearest = std::min(nearest, cv::norm(points[i] - points[which]));
  return nearest;
}

/// Where the edges around a corner meet (Foerstner's operator in cv::cornerSubPix), in a window that reaches
/// a quarter of the way to the next corner: a wider one sees other edges and the bending of the lens, a
/// narrower one more noise. A corner that leaves its window stays where it was.
void refine(const cv::Mat& image, const std::vector<int>& indices, GridSize grid, Points& points) {
  constexpr double kPart = 0.25;
  constexpr int kSmallest_px = 2, kLargest_px = 25;
  const cv::TermCriteria until(cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 60, 1e-4);
  const Points rough = points;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double nearest = std::min(nearest_px(rough, indices, grid, i), kLargest_px / kPart);
    const int half = std::max(kSmallest_px, static_cast<int>(kPart * nearest));
    Points one{rough[i]};
    cv::cornerSubPix(image, one, {half, half}, {-1, -1}, until);
    if (cv::norm(one[0] - rough[i]) < half) points[i] = one[0];
  }
}

BoardCorners numbered(const std::vector<int>& indices, const Points& points) {
  BoardCorners corners;
  for (std::size_t i = 0; i < points.size(); ++i) corners.push_back({indices[i], {points[i].x, points[i].y}});
  std::ranges::sort(corners, {}, &BoardCorner::index);
  return corners;
}

class ChessboardFinder final : public BoardFinder {
 public:
  explicit ChessboardFinder(GridSize grid) : grid_(grid) {
    for (int i = 0; i < grid.columns * grid.rows; ++i) indices_.push_back(i);
  }

  std::optional<BoardCorners> find(const ImageView& image) override {
    const cv::Mat pixels = pixels_of(image);
    Points points;
    try {
      if (!cv::findChessboardCorners(pixels, {grid_.columns, grid_.rows}, points)) return std::nullopt;
      refine(pixels, indices_, grid_, points);
    } catch (const cv::Exception&) {
      return std::nullopt;  // an image that it cannot digest shows no board
    }
    return numbered(indices_, points);
  }

 private:
  GridSize grid_;
  std::vector<int> indices_;
};

class CharucoFinder final : public BoardFinder {
 public:
  CharucoFinder(const Board& board, int dictionary)
      : grid_(board.corners),
        dictionary_(cv::aruco::getPredefinedDictionary(dictionary)),
        board_(cv::aruco::CharucoBoard::create(grid_.columns + 1, grid_.rows + 1,
                                               static_cast<float>(board.square_m),
                                               static_cast<float>(board.marker_m), dictionary_)) {}

  std::optional<BoardCorners> find(const ImageView& image) override {
    const cv::Mat pixels = pixels_of(image);
    Points points;
    std::vector<int> indices;
    try {
      std::vector<Points> markers;
      std::vector<int> ids;
      cv::aruco::detectMarkers(pixels, dictionary_, markers, ids);
      if (ids.empty()) return std::nullopt;
      cv::aruco::interpolateCornersCharuco(markers, ids, pixels, board_, points, indices);
      refine(pixels, indices, grid_, points);
    } catch (const cv::Exception&) {
      return std::nullopt;
    }
    return points.empty() ? std::nullopt : std::optional(numbered(indices, points));
  }

 private:
  GridSize grid_;
  cv::Ptr<cv::aruco::Dictionary> dictionary_;
  cv::Ptr<cv::aruco::CharucoBoard> board_;
};

}  // namespace

std::unique_ptr<BoardFinder> make_chessboard_finder(GridSize corners) {
  cv::setNumThreads(1);
  return std::make_unique<ChessboardFinder>(corners);
}

std::unique_ptr<BoardFinder> make_charuco_finder(const Board& board, int dictionary) {
  cv::setNumThreads(1);
  return std::make_unique<CharucoFinder>(board, dictionary);
}

std::optional<GridSize> guess_chessboard(const ImageView& image) {
  Points points;
  cv::Mat grid;
  try {
    const int flags = cv::CALIB_CB_LARGER | cv::CALIB_CB_NORMALIZE_IMAGE;
    if (!cv::findChessboardCornersSB(pixels_of(image), {3, 3}, points, flags, grid)) return std::nullopt;
  } catch (const cv::Exception&) {
    return std::nullopt;
  }
  return GridSize{std::max(grid.cols, grid.rows), std::min(grid.cols, grid.rows)};
}

}  // namespace waymark::calibrate::opencv
