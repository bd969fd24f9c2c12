#pragma once

#include <filesystem>
#include <memory>
#include <string_view>

#include "workbench/bags/reader.hpp"

namespace waymark::bag {

/// Does a file that begins so call itself a bag of ROS 1, of whatever version?
[[nodiscard]] bool is_ros1_bag(std::string_view first_bytes);

/// Opens a ROS 1 bag of format 2.0 (wiki.ros.org/Bags/Format/2.0), with chunks in bz2, lz4 or neither. One
/// that is not indexed, because recording ended early, or that is cut off is read as far as it goes.
[[nodiscard]] Result<std::unique_ptr<Reader>> open_ros1_bag(const std::filesystem::path& path);

}  // namespace waymark::bag
