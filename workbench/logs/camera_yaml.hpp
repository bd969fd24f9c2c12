#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "waymark/core/result.hpp"
#include "waymark/models/camera.hpp"

namespace waymark {

/// A camera as ROS writes it down (the camera_info YAML of camera_calibration): image_width, image_height,
/// camera_matrix and distortion_coefficients of the plumb_bob model; other entries are passed over. The mount
/// is not in there and stays the default. Errors name file and line.
[[nodiscard]] Result<CameraOptions> read_camera_yaml(const std::filesystem::path& path);
/// The same from memory; `name` stands for the file in errors.
[[nodiscard]] Result<CameraOptions> parse_camera_yaml(const std::string& yaml, const std::string& name);

/// The inverse: reading that gives the same numbers to the last bit.
[[nodiscard]] std::string to_camera_yaml(const CameraOptions& camera, const std::string& name);

/// What a camera_info file holds as config keys `camera.*` and their values: all of the camera but its mount.
[[nodiscard]] std::vector<std::pair<std::string, std::string>> lens_settings(CameraOptions camera);
/// The inverse: takes those keys out of `settings` where they are all there; else nothing.
[[nodiscard]] std::optional<CameraOptions> take_lens(std::map<std::string, std::string>& settings);

}  // namespace waymark
