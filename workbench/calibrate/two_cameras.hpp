#pragma once

#include <array>
#include <optional>
#include <vector>

#include "workbench/calibrate/view.hpp"

namespace waymark::calibrate {

/// Views that are of two cameras, or of one whose focus or zoom moved.
struct TwoCameras {
  struct Group {
    std::vector<std::size_t> views;  ///< their places among all
    double rms_px = 0.0;             ///< by a camera of their own
  };
  std::array<Group, 2> groups;  ///< the first has the first view
  double together_px = 0.0;     ///< RMS of all of them by one camera
  double contrast = 0.0;        ///< see find_two_cameras()
};

/// From this contrast on the views are of two cameras. `waymark-figures cameras` prints how often simulated
/// sets reach it: of one camera (bent and flexing boards, rolling shutters, other lenses), and of two.
inline constexpr double kContrast = 1.0;

/// The split of the views, used ones and outliers, into two groups that two cameras fit best, where it says
/// more than splits of one camera's views do; at least kMinViews are in each.
///
/// It is found like the clusters of k-means: a camera is fitted to each group, and each view goes to the
/// camera that fits it better, until none moves. Where this starts is given by how the views pull at the
/// camera of all (the principal components of their scores), by their errors and fates, by their order and by
/// the letters that their names begin with; nothing but the errors of corners decides.
///
/// A split always lowers the sum of squares, most where the errors of a view belong together (a bent board, a
/// lens that the model does not have), and an F-test with the noise of corners knows nothing of that. So what
/// the split gains is held against what it costs each group that its camera moves when views are left out
/// (the jackknife of HeldOutErrors, as a sum of squares): contrast = gain / mean cost / views. It does not
/// grow with the number of views, and reaches kContrast for two cameras (`min_contrast` is for studies of
/// it); docs/calibration.md says how often it is wrong.
///
/// The lens has four terms, whatever the views support: a fifth makes groups of few views too loose.
/// Some 30 fits for every start: 0.3 s for 15 views of 54 corners, 3 s for 100.
[[nodiscard]] std::optional<TwoCameras> find_two_cameras(const Board& board,
                                                         const std::vector<BoardView>& views,
                                                         double min_contrast = kContrast);

}  // namespace waymark::calibrate
