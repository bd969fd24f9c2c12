#pragma once

#include "waymark/models/camera.hpp"

#include "workbench/bags/topic_reader.hpp"

namespace waymark::bag {

/// Which of the types that hold identities and places of markers, as a detector published them, the messages
/// of this topic have: less for what tells markers rather than any objects; below 0 for none. Of
/// apriltag_msgs the definition decides: some versions have places, the released one has corners alone.
[[nodiscard]] int detection_rank(const Topic& topic);

/// Detected markers, placed in the camera's frame (x right, y down, z forward), as range and bearing in the
/// plane of the robot, about the foot of the camera and from the direction in which it looks:
/// that is the landmark sensor. Places that are told as range and bearing count from the x axis of a frame
/// whose z axis points up, else from the camera's axis. A message without markers says that none was seen.
/// Markers without a usable identity (Identities) or place are left out, and the reader's notes count them.
[[nodiscard]] Result<TopicReader> detection_reader(const Topic& topic, const CameraMount& mount);

/// Of markers whose corners are given, and not where they are.
[[nodiscard]] bool is_outline(const Topic& topic);

/// Are the corners of this type those of images without distortion?
[[nodiscard]] bool outlines_are_rectified(std::string_view type);

/// Reads corners of markers (MarkerOutlines).
[[nodiscard]] Result<TopicReader> outline_reader(const Topic& topic);

/// The family of the first tag in a message as markers.dictionary spells it; empty where there is none.
[[nodiscard]] std::string outline_dictionary(const Topic& topic, std::string_view bytes);

}  // namespace waymark::bag
