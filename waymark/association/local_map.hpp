#pragma once

#include <span>
#include <vector>

#include "waymark/association/find_pose.hpp"
#include "waymark/core/motion.hpp"
#include "waymark/core/observation.hpp"
#include "waymark/models/landmark_sensor.hpp"

namespace waymark {

/// Landmarks as they were last observed, in the robot's present frame, with what observation and odometry are
/// unsure of: what a robot knows of its surroundings that does not know where in its map it is. Only ranges
/// with bearings have a place in it. At most kCapacity landmarks, memory for which is taken at construction.
class LocalMap {
 public:
  static constexpr std::size_t kCapacity = 32;

  explicit LocalMap(const LandmarkSensor& sensor);

  /// The robot moves on. O(landmarks).
  void predict(const Motion& motion);

  /// The latest observation of a landmark stands for all of them: the same identity, or without one the same
  /// place (99.9 % gate). Returns where it is remembered; nullptr where there is no room.
  const ObservedLandmark* observe(const ObservedLandmark& seen);

  /// What the landmark that bears the identity of an observation was last seen to be; nullptr: nothing.
  [[nodiscard]] const ObservedLandmark* find(LandmarkId id) const;
  /// Whether two observations of one landmark, both in the robot's present frame, are of one place (99.9 %
  /// gate).
  [[nodiscard]] static bool agree(const ObservedLandmark& first, const ObservedLandmark& second);
  /// An observation as a place in the robot's frame, with the errors of the sensor that outlive it; nothing
  /// where it has none.
  [[nodiscard]] std::optional<ObservedLandmark> locate(const Observation& observation) const;

  void erase(LandmarkId id);
  void clear() { landmarks_.clear(); }
  [[nodiscard]] std::span<const ObservedLandmark> landmarks() const { return landmarks_; }

 private:
  [[nodiscard]] std::vector<ObservedLandmark>::iterator same_as(const ObservedLandmark& seen);

  Pose2 T_robot_sensor_;
  SensorErrors errors_;
  std::vector<ObservedLandmark> landmarks_;
};

}  // namespace waymark
