#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "waymark/core/result.hpp"

#include "workshop/figures/consistency_study.hpp"

namespace waymark {

/// The page that web/consistency/ is bundled into, as those of workbench/report/pages.hpp.
[[nodiscard]] std::string_view consistency_page();

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
