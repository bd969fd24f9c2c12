#pragma once

#include <filesystem>
#include <functional>

#include "waymark/core/result.hpp"

#include "workbench/logs/source.hpp"

namespace waymark {

/// Reads a source to its end and writes it as a log folder (docs/log-format.md). Reading that gives the same
/// events, stamps and numbers to the last bit, and images the same pixels; ids come back as marker numbers.
/// Images that hold their pixels and have no file become PNG files as they come; nothing else is written when
/// the source fails, when the folder holds files of another log that would mix with this one, or when an
/// observation carries a covariance of its own, for which the format has no place. Holds the text of the log
/// in memory. `progress` is told the part of the source that was read.
[[nodiscard]] Result<void> write_log(Source& source, const std::filesystem::path& folder,
                                     const std::function<void(double)>& progress = {});

}  // namespace waymark
