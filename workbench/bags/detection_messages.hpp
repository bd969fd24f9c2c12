#pragma once

#include "waymark/models/camera.hpp"

#include "workbench/bags/topic_reader.hpp"

namespace waymark::bag {

/// Does a message of this type hold identities and places of markers, as a detector published them?
[[nodiscard]] bool is_detection(std::string_view type);

/// Detected markers, placed in the camera's frame (x right, y down, z forward), as range and bearing in the
/// plane of the robot, about the foot of the camera and from the direction in which it looks:
/// that is the landmark sensor of detection_sensor(). A message without markers says that none was seen.
[[nodiscard]] Result<TopicReader> detection_reader(const Topic& topic, const CameraMount& mount);

/// Of markers whose corners are given, and not where they are.
[[nodiscard]] bool is_outline(std::string_view type);

/// Reads corners of markers (MarkerOutlines).
[[nodiscard]] Result<TopicReader> outline_reader(const Topic& topic);

/// The family of the first tag in a message as markers.dictionary spells it; empty where there is none.
[[nodiscard]] std::string outline_dictionary(const Topic& topic, std::string_view bytes);

}  // namespace waymark::bag
