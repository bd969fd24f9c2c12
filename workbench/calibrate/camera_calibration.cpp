#include "workbench/calibrate/camera_calibration.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>

#include "waymark/core/angle.hpp"

#include "workbench/calibrate/coverage.hpp"
#include "workbench/calibrate/folds.hpp"
#include "workbench/calibrate/weaknesses.hpp"
#include "workbench/eval/median.hpp"

namespace waymark::calibrate {
namespace {

constexpr double kBlurred_px = 4.0;
constexpr double kBlurred = 2.0;  // times the median edge
constexpr double kOutlier = 2.5;  // times the median error
constexpr double kSignificant = 3.0;

std::vector<std::size_t> used(const std::vector<BoardView>& views) {
  std::vector<std::size_t> places;
  for (std::size_t i = 0; i < views.size(); ++i)
    if (views[i].fate == Fate::kUsed) places.push_back(i);
  return places;
}

std::vector<BoardCorners> corners_of(const std::vector<BoardView>& views,
                                     const std::vector<std::size_t>& places) {
  std::vector<BoardCorners> corners;
  for (const std::size_t place : places) corners.push_back(views[place].corners);
  return corners;
}

/// The size of most images that show the board; the others are dropped.
ImageSize settle_size(std::vector<BoardView>& views) {
  std::map<std::pair<int, int>, int> votes;
  for (const std::size_t i : used(views)) ++votes[{views[i].size.width_px, views[i].size.height_px}];
  const auto best = std::ranges::max_element(votes, {}, [](const auto& vote) { return vote.second; });
  const ImageSize size{best->first.first, best->first.second};
  for (const std::size_t i : used(views))
    if (views[i].size != size) {
      views[i].fate = Fate::kOtherSize;
      views[i].why = fmt::format("{} x {} pixels, but most images have {} x {}", views[i].size.width_px,
                                 views[i].size.height_px, size.width_px, size.height_px);
    }
  return size;
}

void drop_blurred(std::vector<BoardView>& views) {
  std::vector<double> edges;
  for (const std::size_t i : used(views)) edges.push_back(views[i].edge_px);
  const double usual_px = *eval::median(std::move(edges));
  for (const std::size_t i : used(views))
    if (views[i].edge_px > std::max(kBlurred_px, kBlurred * usual_px)) {
      views[i].fate = Fate::kBlurred;
      views[i].why = fmt::format("blurred: edges are {:.1f} px wide, usual in this set are {:.1f} px",
                                 views[i].edge_px, usual_px);
    }
}

Error too_few(const Board& board, const std::vector<BoardView>& views) {
  std::map<std::string, int> counts;
  for (const BoardView& view : views)
    if (view.fate != Fate::kUsed) ++counts[name_of(view.fate)];
  std::string others;
  for (const auto& [fate, count] : counts) others += fmt::format(", {} {}", count, fate);
  const auto seen = used(views).size();
  return {fmt::format(
      "{} of {} images show a {}{}; at least {} are needed, and 15 from different sides are recommended",
      seen, views.size(), describe(board), others, kMinViews)};
}

/// Fits, and drops the view that fits worst as long as it stands out.
Result<CameraFit> fit_without_outliers(const Board& board, std::vector<BoardView>& views, ImageSize size) {
  while (true) {
    const auto places = used(views);
    if (places.size() < kMinViews) return too_few(board, views);
    auto fit = fit_camera(board, corners_of(views, places), size, Lens::kFourTerms);
    if (!fit) return fit;
    std::vector<double> errors;
    for (const FittedView& view : fit->views) errors.push_back(view.rms_px());
    const auto worst = std::ranges::max_element(errors);
    const double usual_px = *eval::median(errors);
    if (*worst <= kOutlier * usual_px || places.size() <= 2 * kMinViews) return fit;
    BoardView& view = views[places[static_cast<std::size_t>(worst - errors.begin())]];
    view.fate = Fate::kOutlier;
    view.why = fmt::format(
        "error {:.2f} px, usual in this set are {:.2f} px: the board was bent or moved, or its corners were "
        "found wrongly",
        *worst, usual_px);
  }
}

Result<HeldOutErrors> hold_out(const Board& board, std::vector<BoardView>& views, ImageSize size, Lens lens) {
  HeldOutErrors result;
  std::vector<Intrinsics> cameras;
  std::vector<FittedView> tests;
  for (const Fold& fold : folds_of(used(views))) {
    const auto fit = fit_camera(board, corners_of(views, fold.rest), size, lens);
    if (!fit) return fit.error();
    cameras.push_back(intrinsics_of(fit->camera));
    for (const std::size_t place : fold.left_out) {
      BoardView& view = views[place];
      const auto pose = fit_pose(board, view.corners, fit->camera);
      if (!pose) continue;
      tests.push_back(*pose);
      view.held_out_rms_px = pose->rms_px();
    }
  }
  const auto folds = static_cast<double>(cameras.size());
  result.folds = static_cast<int>(cameras.size());
  result.rms_px = rms_px(tests);
  Intrinsics mean = Intrinsics::Zero(), squares = Intrinsics::Zero();
  for (const Intrinsics& camera : cameras) mean += camera / folds;
  for (const Intrinsics& camera : cameras) squares += (camera - mean).cwiseAbs2();
  result.sigma = (squares * (folds - 1.0) / folds).cwiseSqrt();
  const auto focal = [](const Intrinsics& camera) { return 0.5 * (camera[0] + camera[1]); };
  const auto [shortest, longest] = std::ranges::minmax_element(cameras, {}, focal);
  result.shortest_focal_px = focal(*shortest);
  result.longest_focal_px = focal(*longest);
  return result;
}

/// k3 is estimated where it is significant and helps on views that were left out.
void settle_lens(const Board& board, ImageSize size, CameraCalibration& result) {
  auto fit = fit_camera(board, corners_of(result.views, used(result.views)), size, Lens::kFiveTerms);
  if (!fit) return;
  result.k3_in_sigmas = fit->camera.distortion.k3 / fit->sigma()[8];
  if (std::abs(result.k3_in_sigmas) < kSignificant) return;
  auto views = result.views;
  const auto held_out = hold_out(board, views, size, Lens::kFiveTerms);
  if (!held_out || held_out->rms_px >= result.held_out.rms_px) return;
  result.lens = Lens::kFiveTerms;
  result.fit = *std::move(fit);
  result.held_out = *held_out;
  result.views = std::move(views);
}

void keep_fits(CameraCalibration& result) {
  std::size_t next = 0;
  for (BoardView& view : result.views) {
    if (view.fate == Fate::kUsed) view.fit = result.fit.views[next++];
    if (view.fate == Fate::kOutlier || view.fate == Fate::kBlurred)
      view.fit = fit_pose(result.board, view.corners, result.fit.camera).value_or(FittedView{});
  }
}

}  // namespace

double tilt_deg(const FittedView& view) {
  return to_degrees(std::acos(std::min(1.0, std::abs(view.T_camera_board.linear()(2, 2)))));
}

double distance_m(const FittedView& view, const Board& board) {
  const Eigen::Vector2d middle = 0.5 * (board.corner_m(0) + board.corner_m(board.size() - 1));
  return (view.T_camera_board * Eigen::Vector3d(middle.x(), middle.y(), 0.0)).norm();
}

Result<CameraCalibration> calibrate_camera(const Board& board, std::vector<BoardView> views) {
  if (used(views).size() < kMinViews) return too_few(board, views);
  const ImageSize size = settle_size(views);
  drop_blurred(views);
  auto fit = fit_without_outliers(board, views, size);
  if (!fit) return fit.error();
  CameraCalibration result{.board = board, .views = std::move(views), .fit = *std::move(fit)};
  if (result.used() > kMinViews) {
    auto held_out = hold_out(board, result.views, size, Lens::kFourTerms);
    if (held_out) result.held_out = *held_out;
    if (held_out) settle_lens(board, size, result);
  }
  keep_fits(result);
  result.projection = projection_sigmas(result.fit.camera, result.fit.covariance);
  result.covered = covered_part(result.views, size);
  result.two_cameras = find_two_cameras(board, result.views);
  result.weaknesses = find_weaknesses(result);
  return result;
}

}  // namespace waymark::calibrate
