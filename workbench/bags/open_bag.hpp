#pragma once

#include <filesystem>
#include <memory>

#include "waymark/core/result.hpp"

#include "workbench/bags/reader.hpp"

namespace waymark::bag {

/// Is this a bag of a kind that open_bag() reads? By its first bytes; a folder by its metadata.yaml.
[[nodiscard]] bool is_bag(const std::filesystem::path& path);

/// Opens a ROS 1 bag, a ROS 2 bag (.db3 or .mcap, with its folder or alone), or any other MCAP file.
[[nodiscard]] Result<std::unique_ptr<Reader>> open_bag(const std::filesystem::path& path);

}  // namespace waymark::bag
