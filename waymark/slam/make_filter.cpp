#include "waymark/slam/make_filter.hpp"

namespace waymark {

Result<std::unique_ptr<Filter>> make_filter(const Config& config) {
  const Pose2 T_robot_sensor = config.sensor.T_robot_sensor();
  switch (config.filter) {
    case FilterKind::kEkf:
      if (config.observe != Observe::kRangeBearing)
        return Error{"observe: the EKF takes range-bearing so far; range or bearing alone: filter=fastslam"};
      if (config.associate != Association::kKnown)
        return Error{"associate: the EKF needs identities so far; sightings without: filter=fastslam"};
      return std::unique_ptr<Filter>(std::make_unique<EkfSlam>(config.ekf, config.gate, T_robot_sensor,
                                                               config.threads, config.sensor.errors));
    case FilterKind::kFastSlam:
      if (config.associate == Association::kMl && config.observe != Observe::kRangeBearing)
        return Error{
            "associate: ml takes range-bearing; range or bearing alone needs identities: associate=known"};
      return std::unique_ptr<Filter>(std::make_unique<FastSlam>(
          config.fastslam, config.gate, config.sensor, config.seed, config.threads, PoseEstimate{},
          config.associate == Association::kMl ? std::optional(config.association) : std::nullopt));
  }
  return Error{"filter: unknown"};
}

const char* filter_name(FilterKind kind) { return kind == FilterKind::kEkf ? "EKF-SLAM" : "FastSLAM"; }

}  // namespace waymark
