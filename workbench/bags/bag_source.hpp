#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "waymark/core/result.hpp"

#include "workbench/bags/bag_options.hpp"
#include "workbench/bags/reader.hpp"
#include "workbench/logs/source.hpp"

namespace waymark {

/// A bag as a log. Messages become events in the order of their stamps as far as a window of 5 s, or of 64
/// MB, of what was recorded allows. Images of CompressedImage stay packed until someone loads them. Messages
/// that do not fit their definition, hold what is not finite, or whose stamps jump are skipped and counted; a
/// damaged bag is read as far as it goes, and notes say so. `name` stands for the bag in errors.
[[nodiscard]] Result<std::unique_ptr<Source>> make_bag_source(std::unique_ptr<bag::Reader> bag,
                                                              const std::string& name,
                                                              const BagOptions& options);

/// Opens a bag of ROS 1 or 2, or any MCAP file, as a log.
[[nodiscard]] Result<std::unique_ptr<Source>> open_bag_source(const std::filesystem::path& path,
                                                              const BagOptions& options);

}  // namespace waymark
