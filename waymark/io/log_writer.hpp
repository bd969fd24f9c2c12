#pragma once

#include <filesystem>

#include "waymark/core/result.hpp"
#include "waymark/core/source.hpp"

namespace waymark {

/// Reads a source to its end and writes it as a log folder (docs/log-format.md). Reading that gives the same
/// events, stamps and numbers to the last bit; ids come back as marker numbers. Nothing is written when the
/// source fails, when the folder holds files of another log that would mix with this one, or when an
/// observation carries a covariance of its own, for which the format has no place. Holds the text of the log
/// in memory.
[[nodiscard]] Result<void> write_log(Source& source, const std::filesystem::path& folder);

}  // namespace waymark
