#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "waymark/core/grey_image.hpp"
#include "waymark/kernels/zmssd.hpp"
#include "waymark/vision/corners.hpp"
#include "waymark/vision/patch.hpp"
#include "waymark/vision/search_options.hpp"

namespace waymark::vision {

/// All pixels whose d^T S^-1 d is at most `gate`, and which are at least `before` and `from` pixels inside
/// the image: row `first_row + k` from column rows[k].first on. No bounding box: each row is the solution of
/// a quadratic equation.
struct EllipseRows {
  int first_row = 0;
  std::vector<kernels::WindowRow> rows;
  std::int64_t windows = 0;
};
void find_ellipse_rows(const ImageView& image, const Eigen::Vector2d& centre, const Eigen::Matrix2d& S,
                       double gate, int patch_size, EllipseRows& ellipse);

/// The ZMSSD that two images of one place are expected to have: pixel noise in both, 2 sigma^2 (n - 1), and
/// the place being up to half a pixel beside the window, sum |gradient|^2 / 12 per axis.
[[nodiscard]] double expected_zmssd(const Patch& patch, double grey_sigma);

struct Match {
  int u = 0;
  int v = 0;
  double zmssd = 0.0;
  double distance2 = 0.0;  ///< d^T S^-1 d
  double score = 0.0;      ///< as options say
  bool accepted = false;   ///< similar enough to be the landmark
};

/// Looks for patches in an image where a filter expects them. Holds buffers, so one per thread; allocates for
/// its largest search only.
class Search {
 public:
  explicit Search(const SearchOptions& options = {});

  /// The best window inside the ellipse of `S` (px^2) around `predicted` (px); nothing where none fits into
  /// the image, or S is no covariance. Cost: windows() times some nanoseconds.
  [[nodiscard]] std::optional<Match> find(const ImageView& image, const Patch& patch,
                                          const Eigen::Vector2d& predicted, const Eigen::Matrix2d& S);

  /// Room for images up to this size, so that find() allocates nothing in them.
  void reserve(int width_px, int height_px);

  /// Windows that a find() in this ellipse should score, where it does not leave the image.
  [[nodiscard]] double expected_windows(const Eigen::Matrix2d& S) const;
  /// Windows that the last find() scored.
  [[nodiscard]] std::int64_t windows() const { return windows_; }

 private:
  struct Task;
  void score_ellipse(const Task& task, std::optional<Match>& best);
  void score_corners(const Task& task, std::optional<Match>& best);
  void score_rows(const Task& task, int first_row, const kernels::WindowRow* rows, std::size_t row_count,
                  std::optional<Match>& best);

  SearchOptions options_;
  double gate_;
  kernels::ZmssdSearch zmssd_search_;
  CornerDetector detector_;
  EllipseRows ellipse_;
  std::vector<std::uint32_t> scores_;
  std::vector<Corner> strongest_;
  std::int64_t windows_ = 0;
};

}  // namespace waymark::vision
