#pragma once

#include <optional>
#include <string>

#include "waymark/models/camera.hpp"

#include "workbench/config/schema.hpp"

namespace waymark {

/// What a user may say about a bag. An empty topic is chosen by its type; "none" is not used.
struct BagOptions {
  /// When a message was made, or when it was recorded.
  enum class Stamps { kHeader, kRecorded };

  std::string odometry_topic;
  std::string imu_topic;
  std::string observation_topic;
  std::string image_topic;
  std::string camera_info_topic;
  std::string truth_topic;  ///< only ever used when named
  std::string left_joint;   ///< of the wheels in a JointState
  std::string right_joint;
  std::string camera_file;  ///< ROS camera_info YAML; ranks above the bag's own
  std::string more_bags;    ///< of the same drive, separated by commas
  Stamps stamps = Stamps::kHeader;
  std::optional<CameraMount>
      mount;  ///< no key of its own: the user's camera.mount_*, above the bag's tf_static
};

/// Keys input.*.
void describe(Schema& schema, BagOptions& options);

}  // namespace waymark
