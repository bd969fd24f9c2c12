#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "waymark/core/result.hpp"
#include "waymark/study/consistency.hpp"

namespace waymark {

/// What the page of the consistency study shows.
struct ConsistencyReport {
  std::string command;                                    ///< that made it
  std::vector<study::ConsistencyComparison> comparisons;  ///< that differ in their odometry
};

/// The page as one HTML file that needs nothing else: for each odometry the NEES of all modes over the steps
/// with its 99 % band, and a table.
[[nodiscard]] std::string render_consistency_report(const ConsistencyReport& report);

[[nodiscard]] Result<void> write_consistency_report(const ConsistencyReport& report,
                                                    const std::filesystem::path& path);

}  // namespace waymark
