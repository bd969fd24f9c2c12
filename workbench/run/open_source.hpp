#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>

#include "waymark/core/result.hpp"

#include "workbench/bags/bag_options.hpp"
#include "workbench/config/schema.hpp"
#include "workbench/logs/source.hpp"
#include "workbench/run/input_options.hpp"

namespace waymark {

/// Opens a recording of any known format, recognised by what it holds: a Waymark log folder, an MRCLAM
/// dataset, a bag of ROS 1 or 2, the UWB labyrinth, planar-mono-slam, a Plaza run, lost-in-the-woods,
/// Victoria Park or the car park (the .mat file or its folder; Plaza also as text, Victoria Park also as its
/// graph).
[[nodiscard]] Result<std::unique_ptr<Source>> open_source(const std::filesystem::path& path,
                                                          const InputOptions& options = {});

}  // namespace waymark
