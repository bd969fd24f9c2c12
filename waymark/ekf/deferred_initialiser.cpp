#include "waymark/ekf/deferred_initialiser.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "waymark/core/angle.hpp"
#include "waymark/core/as_index.hpp"
#include "waymark/core/principal_axes.hpp"

namespace waymark::ekf {
namespace {

// Views that are kept of one landmark, the way between them at first, and the fewest that may locate it.
constexpr std::size_t kMaxViews = 12;
constexpr double kFirstSpacing_m = 0.2;
constexpr std::size_t kFewestViews = 4;
// Viewpoints of all landmarks together.
constexpr int kMaxViewpoints = 64;
// How unsure a landmark may be when it is initialised, for its distance from the nearest view.
constexpr double kSureEnough = 0.1;
// Maximum linearisation error of a range, in standard deviations.
constexpr double kBend = 0.3;
// How far off, by the farthest view, a landmark may be before its views are used: nowhere in particular.
constexpr double kAnywhere = 100.0;
// How often its views are linearised anew where the last time led.
constexpr int kIterations = 3;

std::vector<Eigen::Vector2d> ring(const Eigen::Vector2d& centre, double radius_m) {
  constexpr int kPoints = 12;
  std::vector<Eigen::Vector2d> points;
  for (int k = 0; k < kPoints; ++k)
    points.emplace_back(centre +
                        radius_m * rotation_matrix(2.0 * kPi * k / kPoints) * Eigen::Vector2d::UnitX());
  return points;
}

std::vector<Eigen::Vector2d> ray(const Pose2& T_world_sensor, double bearing_rad) {
  constexpr int kPoints = 8;
  constexpr double kNearest_m = 0.5;
  std::vector<Eigen::Vector2d> points;
  for (int k = 0; k < kPoints; ++k)
    points.push_back(T_world_sensor *
                     (std::ldexp(kNearest_m, k) * rotation_matrix(bearing_rad) * Eigen::Vector2d::UnitX()));
  return points;
}

std::vector<Eigen::Vector2d> starts(const Pose2& T_world_sensor, const Measurement& z) {
  if (const auto* range = std::get_if<Range>(&z)) return ring(T_world_sensor.position(), range->range_m);
  return ray(T_world_sensor, std::get<Bearing>(z).bearing_rad);
}

/// So far from the next view, a range to a point that is this unsure sideways is as good as linear, and so is
/// a bearing to one that is this unsure in depth.
bool is_sure(const Located& located, double nearest_m, double range_sigma_m) {
  const double variance = principal_axes(located.covariance).variances[1];
  return variance < kSureEnough * kSureEnough * nearest_m * nearest_m &&
         variance < 2.0 * nearest_m * kBend * range_sigma_m;
}

}  // namespace

DeferredInitialiser::DeferredInitialiser(PointMap& map, const PointObservation& sensor,
                                         Consistency consistency)
    : map_(map), sensor_(sensor), iterations_(consistency == Consistency::kFej ? 0 : kIterations) {
  block_.reserve(kMaxViews);
}

/// The sensor's position is a point on the ground like a landmark, and so is the point one metre ahead of it,
/// which keeps its direction: what turns the world turns them as it should. -1 if there is no room.
int DeferredInitialiser::viewpoint_here(bool with_direction) {
  if (here_ >= 0 && (!with_direction || viewpoints_[as_index(here_)].ahead >= 0)) return here_;
  const auto slot = std::ranges::find(viewpoints_, 0, &Viewpoint::users);
  const int needed = with_direction ? 2 : 1;
  if (slot == viewpoints_.end() && std::ssize(viewpoints_) == kMaxViewpoints) return -1;
  if (map_.state().landmarks() + needed >= map_.state().capacity()) return -1;
  const Pose2 T_world_sensor = sensor_.T_world_sensor();
  Viewpoint made{.place = map_.append_point(T_world_sensor.position())};
  if (with_direction) made.ahead = map_.append_point(T_world_sensor * Eigen::Vector2d::UnitX());
  here_ = static_cast<int>(slot - viewpoints_.begin());
  if (slot == viewpoints_.end())
    viewpoints_.push_back(made);
  else
    *slot = made;
  return here_;
}

void DeferredInitialiser::release(int viewpoint) {
  Viewpoint& left = viewpoints_[as_index(viewpoint)];
  if (--left.users > 0) return;
  if (viewpoint == here_) here_ = -1;
  if (left.ahead >= 0) map_.remove_point(left.ahead);
  map_.remove_point(left.place);
}

/// Keeps a view, and initialises the landmark once its views leave one place for it.
Outcome DeferredInitialiser::observe(LandmarkId id, const Observation& observation) {
  auto found = std::ranges::find(unlocated_, id, &Unlocated::id);
  if (found == unlocated_.end()) found = unlocated_.insert(found, {.id = id, .spacing_m = kFirstSpacing_m});
  Unlocated& unlocated = *found;
  const double travelled_m = map_.table().travelled_m();
  if (!unlocated.views.empty() && travelled_m - unlocated.observed_at_m < unlocated.spacing_m)
    return Outcome::kDeferred;
  if (unlocated.views.size() == kMaxViews) thin(unlocated);
  const int viewpoint = viewpoint_here(std::holds_alternative<Bearing>(observation.value));
  if (viewpoint < 0) return Outcome::kDeferred;
  ++viewpoints_[as_index(viewpoint)].users;
  unlocated.views.push_back({viewpoint, observation.value, (*observation.covariance)(0, 0)});
  unlocated.observed_at_m = travelled_m;
  if (unlocated.views.size() < kFewestViews || !locate(unlocated)) return Outcome::kDeferred;
  for (const PartialView& view : unlocated.views) release(view.viewpoint);
  unlocated_.erase(found);
  return Outcome::kAdded;
}

/// Every other view goes, and those to come are further apart.
void DeferredInitialiser::thin(Unlocated& unlocated) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < unlocated.views.size(); ++i) {
    if (i % 2 == 0)
      unlocated.views[kept++] = unlocated.views[i];
    else
      release(unlocated.views[i].viewpoint);
  }
  unlocated.views.resize(kept);
  unlocated.spacing_m *= 2.0;
}

DeferredInitialiser::Points DeferredInitialiser::points_of(const PartialView& view) const {
  const Viewpoint& viewpoint = viewpoints_[as_index(view.viewpoint)];
  return {map_.index_of_point(viewpoint.place),
          viewpoint.ahead >= 0 ? map_.index_of_point(viewpoint.ahead) : -1};
}

/// `at` gives the points of the state, by index, that Jacobians are taken at, and `here` those of z - h.
template <class Here, class At>
std::optional<LinearizedObservation> DeferredInitialiser::linearize_partial(const PartialView& view,
                                                                            const Eigen::Vector2d& p_world,
                                                                            const Here& here,
                                                                            const At& at) const {
  const Points points = points_of(view);
  const auto pose_of = [&points](const auto& point) -> Pose2 {
    const Eigen::Vector2d place = point(points.place).template head<2>();
    if (points.ahead < 0) return {place.x(), place.y(), 0.0};
    const Eigen::Vector2d ahead = point(points.ahead).template head<2>() - place;
    return {place.x(), place.y(), std::atan2(ahead.y(), ahead.x())};
  };
  std::optional<LinearizedObservation> linearization =
      linearize(view.value, {pose_of(here), p_world}, {pose_of(at), p_world}, Pose2{});
  if (!linearization) return std::nullopt;
  linearization->anchor = points.place;
  linearization->second_anchor = points.ahead;
  linearization->H_anchor.leftCols<2>() = linearization->H_pose.leftCols<2>();
  if (points.ahead >= 0) {
    const Eigen::Vector2d ahead = (at(points.ahead) - at(points.place)).template head<2>();
    linearization->H_second_anchor.leftCols<2>() =
        linearization->H_pose.col(2) * perpendicular(ahead).transpose() / ahead.squaredNorm();
    linearization->H_anchor -= linearization->H_second_anchor;
  }
  linearization->H_pose.setZero();
  // What lasted then is white noise in it now.
  const double range_m = (p_world - here(points.place).template head<2>()).norm();
  const ObservationBias error = sensor_.error_of({}, range_m, view.value);
  linearization->errors = error.terms;
  linearization->R(0, 0) = view.variance + error.unmodelled(0, 0);
  return linearization;
}

/// The views of a landmark that is not in the state, given where it is as seen from the robot: so what is
/// unsure of the robot's own place in the world is unsure of neither side.
std::optional<LinearizedViews> DeferredInitialiser::views_at(const Unlocated& unlocated,
                                                             const Eigen::Vector2d& p_world) const {
  const CompressedState& state = map_.state();
  const auto m = std::ssize(unlocated.views);
  LinearizedViews views{Eigen::VectorXd(m), {m, 2}, Eigen::MatrixXd(m, m)};
  std::vector<LinearizedObservation> linearizations;
  const auto here = [&state](int i) { return state.landmark(i); };
  const auto at = [&state](int i) { return state.linearization_landmark(i); };
  for (Eigen::Index i = 0; i < m; ++i) {
    auto linearization = linearize_partial(unlocated.views[static_cast<std::size_t>(i)], p_world, here, at);
    if (!linearization) return std::nullopt;
    views.nu[i] = linearization->nu[0] - state.active().expected(linearization->errors)[0];
    views.H.row(i) = linearization->H_landmark.block<1, 2>(0, 0);
    linearization->H_pose.leftCols<2>() = linearization->H_landmark.leftCols<2>();
    linearization->H_pose.col(2) = linearization->H_landmark.leftCols<2>() *
                                   perpendicular(p_world - state.active().linearization_pose().position());
    linearization->landmark =
        std::exchange(linearization->anchor, std::exchange(linearization->second_anchor, -1));
    linearization->H_landmark = linearization->H_anchor;
    linearization->H_anchor = linearization->H_second_anchor;
    linearizations.push_back(*linearization);
    for (Eigen::Index j = 0; j <= i; ++j)
      views.S(i, j) = views.S(j, i) =
          state.common_covariance(*linearization, linearizations[static_cast<std::size_t>(j)])(0, 0) +
          (i == j ? linearization->R(0, 0) : 0.0);
  }
  return views;
}

/// All points that the views hang on are to be in the submap of a compressed map.
void DeferredInitialiser::consider_views(const Unlocated& unlocated, int landmark) {
  std::vector<int> points;
  if (landmark >= 0) points.push_back(landmark);
  for (const PartialView& view : unlocated.views) {
    const Points of_view = points_of(view);
    points.push_back(of_view.place);
    if (of_view.ahead >= 0) points.push_back(of_view.ahead);
  }
  map_.state().consider(points);
}

/// Whether the landmark is now in the state.
bool DeferredInitialiser::locate(const Unlocated& unlocated) {
  consider_views(unlocated, -1);
  const PartialView& last = unlocated.views.back();
  const auto located =
      ekf::locate(starts(sensor_.T_world_sensor(), last.value),
                  [&](const Eigen::Vector2d& p_world) { return views_at(unlocated, p_world); });
  if (!located) return false;
  double nearest_m = std::numeric_limits<double>::max();
  double farthest_m = 0.0;
  for (const PartialView& view : unlocated.views) {
    const double range_m = (map_.state().landmark(points_of(view).place).head<2>() - located->p_world).norm();
    nearest_m = std::min(nearest_m, range_m);
    farthest_m = std::max(farthest_m, range_m);
  }
  const bool is_range = std::holds_alternative<Range>(last.value);
  const double range_sigma_m = is_range ? std::sqrt(last.variance) : std::numeric_limits<double>::infinity();
  if (!is_sure(*located, nearest_m, range_sigma_m) || !map_.make_room()) return false;
  return initialise(unlocated, located->p_world, kAnywhere * farthest_m);
}

/// A landmark that may be anywhere around the robot, corrected by all its views at once: each is used once,
/// with whatever its viewpoint has in common with the others, the robot and the map. Until then it is
/// tentative.
bool DeferredInitialiser::initialise(const Unlocated& unlocated, const Eigen::Vector2d& p_world,
                                     double anywhere_m) {
  const int landmark = map_.append(p_world, anywhere_m * anywhere_m * Eigen::Matrix2d::Identity(), {},
                                   {.id = unlocated.id,
                                    .existence = Existence{},
                                    .observations = static_cast<int>(unlocated.views.size())});
  consider_views(unlocated, landmark);
  CompressedState& state = map_.state();
  bool done = gather_views(unlocated, landmark, false) && state.propose(block_);
  for (int i = 0; done && i < iterations_; ++i)
    done = gather_views(unlocated, landmark, true) && state.propose(block_);
  if (done) {
    state.accept();
    map_.table().existence(landmark) = Existence::certain();
  } else {
    map_.remove(landmark);
  }
  return done;
}

/// Linearises all views of a landmark in the state at its estimate, or where the proposal leads.
bool DeferredInitialiser::gather_views(const Unlocated& unlocated, int landmark, bool at_proposal) {
  const CompressedState& state = map_.state();
  const auto now = [&state](int i) { return state.landmark(i); };
  const auto first = [&state](int i) { return state.linearization_landmark(i); };
  const Proposal proposal = state.proposal();
  const auto there = [&proposal](int i) { return proposal.landmark(i); };
  block_.clear();
  for (const PartialView& view : unlocated.views) {
    auto linearization = at_proposal ? linearize_partial(view, there(landmark).head<2>(), there, there)
                                     : linearize_partial(view, now(landmark).head<2>(), now, first);
    if (!linearization) return false;
    linearization->landmark = landmark;
    linearization->nu -= at_proposal ? proposal.expected(linearization->errors)
                                     : state.active().expected(linearization->errors);
    block_.push_back(at_proposal ? proposal.relinearized_to_prior(*linearization) : *linearization);
  }
  return true;
}

}  // namespace waymark::ekf
