#pragma once

#include "waymark/io/bag/topic_reader.hpp"
#include "waymark/models/camera.hpp"

namespace waymark::bag {

/// Does a message of this type hold identities and places of markers, as a detector published them?
[[nodiscard]] bool is_detection(std::string_view type);

/// Detected markers, placed in the camera's frame (x right, y down, z forward), as range and bearing in the
/// plane of the robot, about the foot of the camera and from the direction in which it looks:
/// that is the landmark sensor of detection_sensor(). A message without markers says that none was seen.
[[nodiscard]] Result<TopicReader> detection_reader(const Topic& topic, const CameraMount& mount);

}  // namespace waymark::bag
