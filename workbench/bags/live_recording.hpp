#pragma once

#include <filesystem>
#include <memory>

#include "waymark/core/result.hpp"

#include "workbench/logs/source.hpp"

namespace waymark {

/// A recording of `waymark live --record`: an MCAP file with the topic /waymark/events, whose messages
/// live/recorder.hpp describes.
[[nodiscard]] bool is_live_recording(const std::filesystem::path& path);

/// Its events in the order in which the filter was given them, with what had been processed before each
/// (Source::replay()), and the name and the config of the
/// session as its own. An event that cannot be read ends it.
[[nodiscard]] Result<std::unique_ptr<Source>> open_live_recording(const std::filesystem::path& path);

}  // namespace waymark
