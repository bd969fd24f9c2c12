#include "waymark/ekf/point_map.hpp"

#include <algorithm>
#include <cmath>

#include "waymark/core/text.hpp"

namespace waymark::ekf {
namespace {

/// With kAuto a map is compressed when it is six times a submap: below that it costs more than it saves.
Compression compression(const EkfOptions& options) {
  if (options.odometry.estimate) return {options.submap, options.capacity};
  switch (options.compressed) {
    case Compress::kAlways:
      return {options.submap, std::max(options.submap, options.loaded)};
    case Compress::kNever:
      return {options.submap, options.capacity};
    case Compress::kAuto:
      break;
  }
  return {options.submap, std::max(6 * options.submap, options.loaded)};
}

}  // namespace

PointMap::PointMap(const EkfOptions& options, int bias_pairs, int threads)
    : state_(2, options.capacity, options.consistency, compression(options), threads, bias_pairs),
      management_(options.capacity),
      table_(options.capacity),
      loaded_(options.loaded) {
  extents_.reserve(as_index(options.capacity));
}

Result<void> PointMap::load(const MapState& map) {
  if (auto fits = check_fits(map, 2, state_.capacity()); !fits) return fits;
  if (table_.size() > 0) return Error{"map: can be loaded only before the first motion or observation"};
  if (std::ssize(map.ids) > state_.active().capacity())
    return Error{concat("map: ", map.ids.size(), " landmarks, but EkfOptions::loaded is ", loaded_)};
  state_.load(mean_of(map), map.covariance);
  for (std::size_t i = 0; i < map.ids.size(); ++i) {
    // One without identity, too, is found by the number that the map gives it.
    table_.append({.id = map.ids[i], .observations = map.observations[i]});
    management_.added();
    extents_.emplace_back();
    refresh_place(static_cast<int>(i));
    note_sigma(static_cast<int>(i));
  }
  return {};
}

Snapshot PointMap::snapshot() const {
  Snapshot snapshot{{}, state_.active().pose(), {}};
  for (int i = 0; i < table_.size(); ++i)
    if (table_.is_in_map(i))
      snapshot.landmarks.push_back(
          {table_[i].id, state_.landmark(i), state_.landmark_covariance(i), table_[i].observations});
  return snapshot;
}

MapState PointMap::save() const {
  MapState map;
  map.landmark_dimension = state_.active().dimension();
  map.T_world_robot = state_.active().pose().T_world_robot;
  std::vector<Eigen::Index> rows{0, 1, 2};
  for (int i = 0; i < table_.size(); ++i) {
    if (!table_.is_in_map(i)) continue;
    map.ids.push_back(table_[i].id);
    map.observations.push_back(table_[i].observations);
    const Eigen::Index first = 3 + 2 * i;
    rows.insert(rows.end(), {first, first + 1});
  }
  map.landmarks = Eigen::VectorXd(state_.mean()(rows)).tail(static_cast<Eigen::Index>(rows.size()) - 3);
  map.covariance = state_.covariance()(rows, rows);
  return map;
}

int PointMap::append(const Eigen::Vector2d& p_world, const Eigen::Matrix2d& noise, const BiasTerms& errors,
                     const LandmarkRecord& record) {
  Eigen::Matrix3d G_pose = Eigen::Matrix3d::Zero();
  G_pose.topLeftCorner<2, 2>().setIdentity();
  G_pose.block<2, 1>(0, 2) = perpendicular(p_world - state_.active().linearization_pose().position());
  Eigen::Matrix3d added = Eigen::Matrix3d::Zero();
  added.topLeftCorner<2, 2>() = noise;
  management_.added(record.identity == Identity::kNoLandmark);
  table_.append(record);
  extents_.push_back({p_world});
  return state_.add({p_world.x(), p_world.y(), 0.0}, G_pose, added, errors);
}

void PointMap::remove(int landmark) {
  const LandmarkRecord& last = table_[table_.size() - 1];
  if (last.identity == Identity::kNoLandmark) points_[as_index(last.id.number)] = landmark;
  state_.remove(landmark);
  management_.removed(landmark);
  table_.remove(landmark);
  extents_[as_index(landmark)] = extents_.back();
  extents_.pop_back();
}

bool PointMap::make_room() {
  if (state_.landmarks() < state_.capacity()) return true;
  const auto least_useful = management_.least_useful();
  if (least_useful) remove(*least_useful);
  return least_useful.has_value();
}

int PointMap::append_point(const Eigen::Vector2d& p_world) {
  const auto free = std::ranges::find(points_, -1);
  const auto handle = static_cast<int>(free - points_.begin());
  if (free == points_.end()) points_.push_back(-1);
  points_[as_index(handle)] =
      append(p_world, Eigen::Matrix2d::Zero(), {},
             {.id = {LandmarkId::Family::kNone, handle}, .identity = Identity::kNoLandmark});
  return handle;
}

void PointMap::remove_point(int handle) {
  remove(index_of_point(handle));
  points_[as_index(handle)] = -1;
}

void PointMap::note_sigma(int landmark) {
  extents_[as_index(landmark)].sigma_m =
      std::sqrt(state_.landmark_covariance(landmark).topLeftCorner<2, 2>().trace());
}

}  // namespace waymark::ekf
