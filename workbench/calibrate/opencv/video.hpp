#pragma once

#include <filesystem>
#include <memory>

#include "workbench/calibrate/image_source.hpp"

namespace waymark::calibrate::opencv {

/// Null where OpenCV knows no such video.
[[nodiscard]] std::unique_ptr<ImageSource> open_video(const std::filesystem::path& path);

}  // namespace waymark::calibrate::opencv
