#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include "waymark/core/result.hpp"

#include "workbench/study/sweep_summary.hpp"

namespace waymark {

/// What the page of a sweep shows.
struct SweepReport {
  std::string input;
  std::string command;  ///< that made it
  std::size_t runs = 0;
  study::SweepSummary summary;
};

/// The page as one HTML file that needs nothing else: error, time per step and certainty against the number
/// of particles (or the first axis of numbers), a table of all groups, and beside runs over `study` what the
/// FastSLAM report published.
[[nodiscard]] std::string render_sweep_report(const SweepReport& report);

[[nodiscard]] Result<void> write_sweep_report(const SweepReport& report, const std::filesystem::path& path);

/// The groups of a sweep as JSON: values of the axes, counts, quartiles of every figure.
[[nodiscard]] std::string sweep_json_text(const study::SweepSummary& summary);

}  // namespace waymark
