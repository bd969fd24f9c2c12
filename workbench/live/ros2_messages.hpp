#pragma once

#include <string>
#include <string_view>

#include "waymark/core/motion.hpp"
#include "waymark/core/stamp.hpp"

namespace waymark::live::ros2 {

/// Messages of ROS 2 as CDR, little endian, with their four bytes of encapsulation; and their definitions.
/// Frames are those of REP-105.
extern const char* const kCompressedImage;
extern const char* const kPoseWithCovarianceStamped;

/// sensor_msgs/CompressedImage; the format is told by the first bytes, jpeg or png.
[[nodiscard]] std::string compressed_image(Stamp stamp, std::string_view frame, std::string_view bytes);

/// geometry_msgs/PoseWithCovarianceStamped, on the plane: what it does not know of height, roll and pitch has
/// no variance.
[[nodiscard]] std::string pose_with_covariance(Stamp stamp, std::string_view frame, const PoseEstimate& pose);

}  // namespace waymark::live::ros2
