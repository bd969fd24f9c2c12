#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Geometry>

#include "waymark/core/result.hpp"
#include "waymark/models/camera.hpp"

#include "workbench/bags/reader.hpp"

namespace waymark::bag {

inline constexpr std::string_view kCameraInfo = "sensor_msgs/CameraInfo";
inline constexpr std::string_view kTransforms = "tf2_msgs/TFMessage";

/// The lens that a sensor_msgs/CameraInfo describes: the plumb_bob model, or none for images that are
/// `rectified` already. An error: it was never calibrated, or is of another model.
[[nodiscard]] Result<CameraOptions> read_camera_info(const Topic& topic, std::string_view bytes,
                                                     bool rectified);

/// The frame that a message with a header is about; for nav_msgs/Odometry `field` is "child_frame_id". Empty
/// where it does not say.
[[nodiscard]] std::string read_frame(const Topic& topic, std::string_view bytes, const std::string& field);

/// The transforms of tf_static: a tree of frames, each fixed in its parent.
class FrameTree {
 public:
  /// A message that can not be read, and transforms that are not finite, are passed over.
  void add(const Topic& topic, std::string_view bytes);

  /// T_ancestor_frame; nothing where the frame does not hang on that ancestor.
  [[nodiscard]] std::optional<Eigen::Isometry3d> find(const std::string& ancestor,
                                                      const std::string& frame) const;

 private:
  struct Joint {
    std::string parent;
    Eigen::Isometry3d T_parent_frame;
  };
  std::map<std::string, Joint> joints_;  // by the frame that is fixed
};

/// The mount that has this place on the robot.
[[nodiscard]] CameraMount to_mount(const Eigen::Isometry3d& T_robot_camera);

}  // namespace waymark::bag
