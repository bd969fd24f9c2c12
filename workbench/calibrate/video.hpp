#pragma once

#include <filesystem>
#include <memory>

#include "workbench/calibrate/image_source.hpp"

namespace waymark::calibrate {

/// The frames of a video, kFramesPerSecond of them; an error where OpenCV knows no such video or its module
/// is missing.
[[nodiscard]] Result<std::unique_ptr<ImageSource>> open_video(const std::filesystem::path& path);

}  // namespace waymark::calibrate
