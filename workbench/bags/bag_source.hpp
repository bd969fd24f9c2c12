#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include "waymark/core/result.hpp"

#include "workbench/bags/bag_options.hpp"
#include "workbench/bags/reader.hpp"
#include "workbench/logs/source.hpp"

namespace waymark {

/// Opens the same bag once more.
using ReopenBag = std::function<Result<std::unique_ptr<bag::Reader>>()>;

/// A bag as a log. It is looked through once to find the order of time of its messages (find_time_order);
/// then these become events in that order. Images of CompressedImage stay packed until someone loads them.
/// Messages that do not fit their definition, hold what is not finite, or whose stamps jump are skipped and
/// counted; a damaged bag is read as far as it goes, and notes say so. `name` stands for the bag in errors.
/// Where messages lie more than a second behind later ones in the file, `reopen` gives each topic a reader
/// of its own; without it more is held. Memory: below 100 bytes per message that is used, and what is held,
/// at most 256 MB.
[[nodiscard]] Result<std::unique_ptr<Source>> make_bag_source(std::unique_ptr<bag::Reader> bag,
                                                              const std::string& name,
                                                              const BagOptions& options,
                                                              const ReopenBag& reopen = {});

/// Opens a bag of ROS 1 or 2, or any MCAP file, as a log.
[[nodiscard]] Result<std::unique_ptr<Source>> open_bag_source(const std::filesystem::path& path,
                                                              const BagOptions& options);

}  // namespace waymark
