// What EkfSlam does with ranges or bearings of landmarks that it cannot place yet.

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include <Eigen/Eigenvalues>

#include "waymark/core/angle.hpp"
#include "waymark/core/principal_axes.hpp"
#include "waymark/ekf/ekf_slam.hpp"
#include "waymark/ekf/locate.hpp"

namespace waymark {
namespace {

// Views that are kept of one landmark, the way between them at first, and the fewest that may place it.
constexpr std::size_t kMostViews = 12;
constexpr double kFirstSpacing_m = 0.2;
constexpr std::size_t kFewestViews = 4;
// Viewpoints of all landmarks together.
constexpr int kMostViewpoints = 64;
// How unsure a landmark may be when it is placed, for its distance from the nearest view.
constexpr double kSureEnough = 0.1;
// By how much of its standard deviation a range may leave the linear within that.
constexpr double kBend = 0.3;
// How far off, by the farthest view, a landmark may be before its views are used: nowhere in particular.
constexpr double kAnywhere = 100.0;
constexpr int kPlacements = 3;

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
bool is_sure(const ekf::Located& located, double nearest_m, double range_sigma_m) {
  const double variance = principal_axes(located.covariance).variances[1];
  return variance < kSureEnough * kSureEnough * nearest_m * nearest_m &&
         variance < 2.0 * nearest_m * kBend * range_sigma_m;
}

}  // namespace

/// The sensor's position is a point on the ground like a landmark, and so is the point one metre ahead of it,
/// which keeps its direction: what turns the world turns them as it should. -1 if there is no room.
int EkfSlam::viewpoint_here(bool with_direction) {
  const bool made_already = viewpoint_of_scan_ >= 0;
  if (made_already &&
      (!with_direction || viewpoints_[static_cast<std::size_t>(viewpoint_of_scan_)].ahead >= 0))
    return viewpoint_of_scan_;
  const auto slot = std::ranges::find(viewpoints_, 0, &Viewpoint::users);
  const int needed = with_direction ? 2 : 1;
  if (slot == viewpoints_.end() && std::ssize(viewpoints_) == kMostViewpoints) return -1;
  if (state_.landmarks() + needed >= state_.capacity()) return -1;
  const Pose2 T_world_sensor = state_.pose().T_world_robot * T_robot_sensor_;
  const auto keep = [this](const Eigen::Vector2d& p_world) {
    return append(p_world, Eigen::Matrix2d::Zero(), {}, {.is_viewpoint = true, .place_m = p_world});
  };
  Viewpoint made{.place = keep(T_world_sensor.position())};
  if (with_direction) made.ahead = keep(T_world_sensor * Eigen::Vector2d::UnitX());
  viewpoint_of_scan_ = static_cast<int>(slot - viewpoints_.begin());
  if (slot == viewpoints_.end())
    viewpoints_.push_back(made);
  else
    *slot = made;
  return viewpoint_of_scan_;
}

void EkfSlam::release(int viewpoint) {
  Viewpoint& left = viewpoints_[static_cast<std::size_t>(viewpoint)];
  if (--left.users > 0) return;
  if (viewpoint == viewpoint_of_scan_) viewpoint_of_scan_ = -1;
  const int ahead = std::exchange(left.ahead, -1);
  if (ahead >= 0) remove(ahead);
  remove(std::exchange(left.place, -1));
}

/// A viewpoint's point has a new index.
void EkfSlam::renumber_viewpoint(int from, int to) {
  for (Viewpoint& viewpoint : viewpoints_) {
    if (viewpoint.place == from) viewpoint.place = to;
    if (viewpoint.ahead == from) viewpoint.ahead = to;
  }
}

/// Keeps a view, and places the landmark once its views leave one place for it.
void EkfSlam::defer(std::size_t index, const Observation& observation) {
  const LandmarkId id = innovations_[index].landmark;
  innovations_[index].outcome = Outcome::kPending;
  auto found = std::ranges::find(unlocated_, id, &Unlocated::id);
  if (found == unlocated_.end()) found = unlocated_.insert(found, {.id = id, .spacing_m = kFirstSpacing_m});
  Unlocated& unlocated = *found;
  if (!unlocated.views.empty() && way_m_ - unlocated.seen_at_way_m < unlocated.spacing_m) return;
  if (unlocated.views.size() == kMostViews) thin(unlocated);
  const int viewpoint = viewpoint_here(std::holds_alternative<Bearing>(observation.value));
  if (viewpoint < 0) return;
  ++viewpoints_[static_cast<std::size_t>(viewpoint)].users;
  unlocated.views.push_back({viewpoint, observation.value, (*observation.covariance)(0, 0)});
  unlocated.seen_at_way_m = way_m_;
  if (unlocated.views.size() < kFewestViews || !locate(unlocated)) return;
  innovations_[index].outcome = Outcome::kAdded;
  for (const PartialView& view : unlocated.views) release(view.viewpoint);
  unlocated_.erase(found);
}

/// Every other view goes, and those to come are further apart.
void EkfSlam::thin(Unlocated& unlocated) {
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

/// `at` gives the points of the state, by index, that Jacobians are taken at, and `here` those of z - h.
template <class Here, class At>
std::optional<ekf::Sighting> EkfSlam::look_back(const PartialView& view, const Eigen::Vector2d& p_world,
                                                const Here& here, const At& at) const {
  const Viewpoint& viewpoint = viewpoints_[static_cast<std::size_t>(view.viewpoint)];
  const auto pose_of = [&viewpoint](const auto& point) -> Pose2 {
    const Eigen::Vector2d place = point(viewpoint.place).template head<2>();
    if (viewpoint.ahead < 0) return {place.x(), place.y(), 0.0};
    const Eigen::Vector2d ahead = point(viewpoint.ahead).template head<2>() - place;
    return {place.x(), place.y(), std::atan2(ahead.y(), ahead.x())};
  };
  const Eigen::Vector3d p(p_world.x(), p_world.y(), 0.0);
  std::optional<ekf::Sighting> sighting = sight(view.value, {pose_of(here), p}, {pose_of(at), p}, Pose2{});
  if (!sighting) return std::nullopt;
  sighting->anchor = viewpoint.place;
  sighting->second_anchor = viewpoint.ahead;
  sighting->H_anchor.leftCols<2>() = sighting->H_pose.leftCols<2>();
  if (viewpoint.ahead >= 0) {
    const Eigen::Vector2d ahead = (at(viewpoint.ahead) - at(viewpoint.place)).template head<2>();
    sighting->H_second_anchor.leftCols<2>() =
        sighting->H_pose.col(2) * perpendicular(ahead).transpose() / ahead.squaredNorm();
    sighting->H_anchor -= sighting->H_second_anchor;
  }
  sighting->H_pose.setZero();
  // What lasted then is white noise in it now.
  const double range_m = (p_world - here(viewpoint.place).template head<2>()).norm();
  const ekf::SightingError error = error_of({}, range_m, view.value);
  sighting->errors = error.terms;
  sighting->R(0, 0) = view.variance + error.unmodelled(0, 0);
  return sighting;
}

/// The views of a landmark that is not in the state, given where it is as seen from the robot: so what is
/// unsure of the robot's own place in the world is unsure of neither side.
std::optional<ekf::ViewsOfOne> EkfSlam::views_at(const Unlocated& unlocated,
                                                 const Eigen::Vector2d& p_world) const {
  const auto m = std::ssize(unlocated.views);
  ekf::ViewsOfOne views{Eigen::VectorXd(m), {m, 2}, Eigen::MatrixXd(m, m)};
  std::vector<ekf::Sighting> sightings;
  const auto here = [this](int i) { return state_.landmark(i); };
  const auto at = [this](int i) { return state_.linearization_landmark(i); };
  for (Eigen::Index i = 0; i < m; ++i) {
    auto sighting = look_back(unlocated.views[static_cast<std::size_t>(i)], p_world, here, at);
    if (!sighting) return std::nullopt;
    views.nu[i] = sighting->nu[0] - state_.expected(sighting->errors)[0];
    views.H.row(i) = sighting->H_landmark.block<1, 2>(0, 0);
    sighting->H_pose.leftCols<2>() = sighting->H_landmark.leftCols<2>();
    sighting->H_pose.col(2) =
        sighting->H_landmark.leftCols<2>() * perpendicular(p_world - state_.linearization_pose().position());
    sighting->landmark = std::exchange(sighting->anchor, std::exchange(sighting->second_anchor, -1));
    sighting->H_landmark = sighting->H_anchor;
    sighting->H_anchor = sighting->H_second_anchor;
    sightings.push_back(*sighting);
    for (Eigen::Index j = 0; j <= i; ++j)
      views.S(i, j) = views.S(j, i) =
          state_.common_covariance(*sighting, sightings[static_cast<std::size_t>(j)])(0, 0) +
          (i == j ? sighting->R(0, 0) : 0.0);
  }
  return views;
}

/// All points that the views hang on are to be in the region of a compressed map.
void EkfSlam::consider_views(const Unlocated& unlocated, int landmark) {
  std::vector<int> points;
  if (landmark >= 0) points.push_back(landmark);
  for (const PartialView& view : unlocated.views) {
    const Viewpoint& viewpoint = viewpoints_[static_cast<std::size_t>(view.viewpoint)];
    points.push_back(viewpoint.place);
    if (viewpoint.ahead >= 0) points.push_back(viewpoint.ahead);
  }
  state_.consider(points);
}

/// Whether the landmark is now in the state.
bool EkfSlam::locate(const Unlocated& unlocated) {
  consider_views(unlocated, -1);
  const PartialView& last = unlocated.views.back();
  const auto located =
      ekf::locate(starts(state_.pose().T_world_robot * T_robot_sensor_, last.value),
                  [&](const Eigen::Vector2d& p_world) { return views_at(unlocated, p_world); });
  if (!located) return false;
  double nearest_m = std::numeric_limits<double>::max();
  double farthest_m = 0.0;
  for (const PartialView& view : unlocated.views) {
    const int place = viewpoints_[static_cast<std::size_t>(view.viewpoint)].place;
    const double range_m = (state_.landmark(place).head<2>() - located->p_world).norm();
    nearest_m = std::min(nearest_m, range_m);
    farthest_m = std::max(farthest_m, range_m);
  }
  const bool is_range = std::holds_alternative<Range>(last.value);
  const double range_sigma_m = is_range ? std::sqrt(last.variance) : std::numeric_limits<double>::infinity();
  if (!is_sure(*located, nearest_m, range_sigma_m) || !make_room()) return false;
  return place(unlocated, located->p_world, kAnywhere * farthest_m);
}

/// A landmark that may be anywhere around the robot, corrected by all its views at once: each is used once,
/// with whatever its viewpoint has in common with the others, the robot and the map.
bool EkfSlam::place(const Unlocated& unlocated, const Eigen::Vector2d& p_world, double anywhere_m) {
  const int landmark = append(
      p_world, anywhere_m * anywhere_m * Eigen::Matrix2d::Identity(), {},
      {.id = unlocated.id, .observations = static_cast<int>(unlocated.views.size()), .place_m = p_world});
  index_.assign(unlocated.id, landmark);
  consider_views(unlocated, landmark);
  bool placed = gather_views(unlocated, landmark, false) && state_.propose(sightings_);
  const int more = options_.consistency == ekf::Consistency::kFej ? 0 : kPlacements;
  for (int i = 0; placed && i < more; ++i)
    placed = gather_views(unlocated, landmark, true) && state_.propose(sightings_);
  if (placed) {
    state_.accept();
  } else {
    remove(landmark);
    removed_.pop_back();
  }
  return placed;
}

/// Linearises all views of a landmark in the state at its estimate, or where the proposal leads.
bool EkfSlam::gather_views(const Unlocated& unlocated, int landmark, bool at_proposal) {
  const auto now = [this](int i) { return state_.landmark(i); };
  const auto first = [this](int i) { return state_.linearization_landmark(i); };
  const auto there = [this](int i) { return state_.proposed_landmark(i); };
  sightings_.clear();
  for (const PartialView& view : unlocated.views) {
    auto sighting = at_proposal ? look_back(view, there(landmark).head<2>(), there, there)
                                : look_back(view, now(landmark).head<2>(), now, first);
    if (!sighting) return false;
    sighting->landmark = landmark;
    sighting->nu -=
        at_proposal ? state_.proposed_expected(sighting->errors) : state_.expected(sighting->errors);
    sightings_.push_back(at_proposal ? state_.moved_back(*sighting) : *sighting);
  }
  return true;
}

}  // namespace waymark
