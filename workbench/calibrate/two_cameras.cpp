#include "workbench/calibrate/two_cameras.hpp"

#include <algorithm>
#include <numeric>
#include <set>

#include "waymark/core/symmetric_eigen.hpp"

#include "workbench/calibrate/folds.hpp"

namespace waymark::calibrate {
namespace {

using Places = std::vector<std::size_t>;
/// Which views are of the second group. The first view never is, so that a split has one name.
using Sides = std::vector<bool>;

struct Task {
  const Board& board;
  const std::vector<BoardView>& all;
  Places places;  ///< of the views to split
  ImageSize size;

  [[nodiscard]] const BoardView& view(std::size_t i) const { return all[places[i]]; }
  [[nodiscard]] std::size_t count() const { return places.size(); }

  [[nodiscard]] Result<CameraFit> fit(const Places& members) const {
    std::vector<BoardCorners> corners;
    for (const std::size_t i : members) corners.push_back(view(i).corners);
    return fit_camera(board, corners, size, Lens::kFourTerms);
  }
};

struct Split {
  Sides sides;
  std::array<CameraFit, 2> fits;
};

double sum_of_squares(const FittedView& view) {
  double sum = 0.0;
  for (const Eigen::Vector2d& r : view.residuals_px) sum += r.squaredNorm();
  return sum;
}

double sum_of_squares(const CameraFit& fit) {
  double sum = 0.0;
  for (const FittedView& view : fit.views) sum += sum_of_squares(view);
  return sum;
}

double sum_of_squares(const Split& split) {
  return sum_of_squares(split.fits[0]) + sum_of_squares(split.fits[1]);
}

Places members(const Sides& sides, bool side) {
  Places places;
  for (std::size_t i = 0; i < sides.size(); ++i)
    if (sides[i] == side) places.push_back(i);
  return places;
}

Sides named_by_first(Sides sides) {
  if (sides.front()) sides.flip();
  return sides;
}

/// A view is on the second side where `values` are above `limit`.
Sides above(const Eigen::VectorXd& values, double limit) {
  Sides sides;
  for (const double value : values) sides.push_back(value > limit);
  return named_by_first(std::move(sides));
}

/// How the corners of a view pull at the intrinsics: the derivative of half its sum of squares, turned round.
/// The pose has no part in it, for it is where nothing pulls at it.
Intrinsics score(const Task& task, const BoardView& view, const FittedView& fit, const Camera& camera) {
  Intrinsics sum = Intrinsics::Zero();
  for (std::size_t k = 0; k < view.corners.size(); ++k) {
    const Eigen::Vector2d m = task.board.corner_m(view.corners[k].index);
    const Eigen::Vector3d p_camera = fit.T_camera_board * Eigen::Vector3d(m.x(), m.y(), 0.0);
    sum += intrinsics_jacobian(camera, p_camera).transpose() * fit.residuals_px[k];
  }
  return sum;
}

/// The scores of the views in the rows, in units of what noise of the corners would make.
Eigen::MatrixXd scores(const Task& task, const CameraFit& one) {
  const auto [variances, directions] = symmetric_eigen(one.covariance);
  const Intrinsics sigma = variances.cwiseMax(0.0).cwiseSqrt();
  const IntrinsicsCovariance to_noise = sigma.asDiagonal() * directions.transpose();
  const Camera camera(one.camera);
  Eigen::MatrixXd rows(task.count(), kIntrinsics);
  for (std::size_t i = 0; i < task.count(); ++i)
    rows.row(static_cast<Eigen::Index>(i)) = to_noise * score(task, task.view(i), one.views[i], camera);
  return rows;
}

std::string leading_letters(const std::string& name) {
  return name.substr(0, name.find_first_of("0123456789"));
}

Sides by_name(const Task& task) {
  Sides sides;
  for (std::size_t i = 0; i < task.count(); ++i)
    sides.push_back(leading_letters(task.view(i).name) != leading_letters(task.view(0).name));
  return sides;
}

/// What was dropped may be the other camera's.
Sides by_fate(const Task& task) {
  Sides sides;
  for (std::size_t i = 0; i < task.count(); ++i) sides.push_back(task.view(i).fate == Fate::kOutlier);
  return named_by_first(std::move(sides));
}

std::vector<Sides> starts(const Task& task, const CameraFit& one) {
  constexpr Eigen::Index kComponents = 3;
  const auto count = static_cast<Eigen::Index>(task.count());
  std::vector<Sides> result{by_fate(task), by_name(task)};
  result.push_back(above(Eigen::VectorXd::LinSpaced(count, -1.0, 1.0), 0.0));
  const Eigen::Matrix<double, Eigen::Dynamic, kIntrinsics> rows = scores(task, one);
  const SmallMatrix axes =
      symmetric_eigen(rows.transpose() * rows).vectors;  // the principal ones are the last
  for (Eigen::Index k = 1; k <= kComponents; ++k)
    result.push_back(above(rows * axes.col(kIntrinsics - k), 0.0));
  Eigen::VectorXd errors(count);
  std::ranges::transform(one.views, errors.begin(), [](const FittedView& view) { return view.rms_px(); });
  Eigen::VectorXd sorted = errors;
  std::ranges::sort(sorted, std::greater());
  for (const Eigen::Index worst : {Eigen::Index{kMinViews}, count / 4})
    result.push_back(above(errors, sorted[worst]));
  return result;
}

/// Nothing where a group is too small, or leaves its camera open.
std::optional<Split> fit_groups(const Task& task, const Sides& sides) {
  Split split{.sides = sides, .fits = {}};
  for (const bool side : {false, true}) {
    const Places group = members(sides, side);
    if (group.size() < kMinViews) return std::nullopt;
    auto fit = task.fit(group);
    if (!fit) return std::nullopt;
    split.fits[side] = *std::move(fit);
  }
  return split;
}

/// Each view goes to the camera that fits it better.
Sides reassigned(const Task& task, const Split& split) {
  Sides sides = split.sides;
  for (std::size_t i = 0; i < task.count(); ++i) {
    const auto first = fit_pose(task.board, task.view(i).corners, split.fits[0].camera);
    const auto second = fit_pose(task.board, task.view(i).corners, split.fits[1].camera);
    if (first && second) sides[i] = sum_of_squares(*second) < sum_of_squares(*first);
  }
  return named_by_first(std::move(sides));
}

/// From a start to where no view moves, or to a split that was `seen` from another start.
std::optional<Split> improved(const Task& task, Sides sides, std::set<Sides>& seen) {
  std::optional<Split> best;
  while (seen.insert(sides).second) {
    auto split = fit_groups(task, sides);
    if (!split) break;
    sides = reassigned(task, *split);
    best = std::move(split);
  }
  return best;
}

std::optional<Split> best_split(const Task& task, const CameraFit& one) {
  std::optional<Split> best;
  std::set<Sides> seen;
  for (const Sides& start : starts(task, one)) {
    auto split = improved(task, start, seen);
    if (split && (!best || sum_of_squares(*split) < sum_of_squares(*best))) best = std::move(split);
  }
  return best;
}

/// Of some views by a camera that was fitted to others; nothing where it cannot have taken them.
std::optional<double> sum_of_squares(const Task& task, const Places& group, const CameraOptions& camera) {
  double sum = 0.0;
  for (const std::size_t i : group) {
    const auto pose = fit_pose(task.board, task.view(i).corners, camera);
    if (!pose) return std::nullopt;
    sum += sum_of_squares(*pose);
  }
  return sum;
}

/// What it costs a group, as a sum of squares, that its camera moves as it does between folds.
std::optional<double> jackknife_cost_px2(const Task& task, const Places& group, const CameraFit& fit) {
  const auto folds = folds_of(group);
  double sum = 0.0;
  for (const Fold& fold : folds) {
    const auto without = task.fit(fold.rest);
    const auto squares = without ? sum_of_squares(task, group, without->camera) : std::nullopt;
    if (!squares) return std::nullopt;
    sum += *squares - sum_of_squares(fit);
  }
  const auto count = static_cast<double>(folds.size());
  return (count - 1.0) / count * sum;
}

std::optional<double> contrast_of(const Task& task, const CameraFit& one, const Split& split) {
  double cost_px2 = 0.0;
  for (const bool side : {false, true}) {
    const auto cost = jackknife_cost_px2(task, members(split.sides, side), split.fits[side]);
    if (!cost) return std::nullopt;
    cost_px2 += 0.5 * *cost;
  }
  const double gain_px2 = sum_of_squares(one) - sum_of_squares(split);
  return gain_px2 / cost_px2 / static_cast<double>(task.count());
}

Places to_split(const std::vector<BoardView>& views) {
  Places places;
  for (std::size_t i = 0; i < views.size(); ++i)
    if (views[i].fate == Fate::kUsed || views[i].fate == Fate::kOutlier) places.push_back(i);
  return places;
}

TwoCameras::Group group_of(const Task& task, const Split& split, bool side) {
  TwoCameras::Group group{.views = {}, .rms_px = split.fits[side].rms_px};
  for (const std::size_t i : members(split.sides, side)) group.views.push_back(task.places[i]);
  return group;
}

}  // namespace

std::optional<TwoCameras> find_two_cameras(const Board& board, const std::vector<BoardView>& views,
                                           double min_contrast) {
  Task task{.board = board, .all = views, .places = to_split(views), .size = {}};
  if (task.count() < 2 * kMinViews) return std::nullopt;
  task.size = task.view(0).size;
  Places all(task.count());
  std::iota(all.begin(), all.end(), 0);
  const auto one = task.fit(all);
  const auto split = one ? best_split(task, *one) : std::nullopt;
  const auto contrast = split ? contrast_of(task, *one, *split) : std::nullopt;
  if (!contrast || *contrast < min_contrast) return std::nullopt;
  return TwoCameras{.groups = {group_of(task, *split, false), group_of(task, *split, true)},
                    .together_px = one->rms_px,
                    .contrast = *contrast};
}

}  // namespace waymark::calibrate
