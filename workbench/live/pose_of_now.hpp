#pragma once

#include <mutex>
#include <optional>
#include <vector>

#include "waymark/core/motion.hpp"
#include "waymark/slam/odometer.hpp"

namespace waymark::live {

struct StampedPose {
  Stamp stamp;
  PoseEstimate estimate;
};

/// Where the robot is by its newest odometry: the pose that the filter last knew, and the motion since
/// (T_world_now = T_world_filter * T_filter_now, covariance to first order). The filter may be behind by an
/// image that it still looks into; this never is. For two threads: that of the odometry adds, that of the
/// filter corrects. Each holds the lock for microseconds.
class PoseOfNow {
 public:
  PoseOfNow(const OdometryOptions& odometry, double max_hold_s);

  /// A reading of the odometry or of the gyro beside it. The pose at its moment; nothing before the filter
  /// has told its first, or for what is not the odometry that is followed.
  std::optional<StampedPose> add(const Event& event);

  /// What the filter knows of a moment.
  void correct(const StampedPose& pose);

  [[nodiscard]] std::optional<StampedPose> now() const;

 private:
  struct Segment {
    Stamp from;
    Stamp to;
    Motion motion;
  };
  void forget_segments_before(Stamp stamp);

  mutable std::mutex mutex_;
  Odometer odometer_;
  Duration response_;
  std::optional<Stamp> reached_;   // by the odometer
  std::vector<Segment> segments_;  // since the filter's pose, in the order of time
  std::optional<StampedPose> now_;
};

}  // namespace waymark::live
