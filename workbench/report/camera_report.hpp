#pragma once

#include <filesystem>
#include <string>

#include "waymark/core/result.hpp"

#include "workbench/calibrate/camera_calibration.hpp"

namespace waymark {

/// What the page of a camera's calibration shows.
struct CameraReport {
  std::string command;  ///< that made it
  calibrate::CameraCalibration calibration;
};

/// The page as one HTML file that needs nothing else: the verdict, the intrinsics with their uncertainty, the
/// corners of all views over the image, a table of views, and the errors drawn into the images.
[[nodiscard]] std::string render_camera_report(const CameraReport& report);

[[nodiscard]] Result<void> write_camera_report(const CameraReport& report, const std::filesystem::path& path);

/// The same without images and corners, for programs.
[[nodiscard]] std::string camera_json_text(const calibrate::CameraCalibration& calibration);

}  // namespace waymark
