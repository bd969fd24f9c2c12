#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "waymark/core/result.hpp"

#include "workbench/bags/reader.hpp"

namespace waymark::bag {

/// Is this a bag of a kind that open_bag() reads? By its first bytes; a folder of ROS 2 by its metadata.yaml,
/// or by .db3 and .mcap files.
[[nodiscard]] bool is_bag(const std::filesystem::path& path);

/// Are there ROS 1 bags in the folder?
[[nodiscard]] bool is_folder_of_bags(const std::filesystem::path& folder);

/// Opens a ROS 1 bag, a ROS 2 bag (.db3 or .mcap, with its folder or alone), or any other MCAP file; each
/// also packed by zstd. The first part of a ROS 1 recording that was split stands for all of them, as does
/// their folder; bags of different recordings in one folder are an error.
[[nodiscard]] Result<std::unique_ptr<Reader>> open_bag(const std::filesystem::path& path);

/// Opens bags of one drive, which were recorded by one clock, as one bag: parts of it, or other topics in
/// each.
[[nodiscard]] Result<std::unique_ptr<Reader>> open_bags(const std::vector<std::filesystem::path>& paths);

}  // namespace waymark::bag
