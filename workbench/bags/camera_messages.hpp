#pragma once

#include <string>
#include <string_view>

#include "waymark/core/result.hpp"
#include "waymark/models/camera.hpp"

#include "workbench/bags/frame_tree.hpp"
#include "workbench/bags/reader.hpp"

namespace waymark::bag {

inline constexpr std::string_view kCameraInfo = "sensor_msgs/CameraInfo";

/// The lens that a sensor_msgs/CameraInfo describes: the plumb_bob model, or none for images that are
/// `rectified` already. An error: it was never calibrated, or is of another model.
[[nodiscard]] Result<CameraOptions> read_camera_info(const Topic& topic, std::string_view bytes,
                                                     bool rectified);

/// The frame that a message with a header is about; for nav_msgs/Odometry `field` is "child_frame_id". Empty
/// where it does not say.
[[nodiscard]] std::string read_frame(const Topic& topic, std::string_view bytes, const std::string& field);

}  // namespace waymark::bag
