#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "workbench/study/sweep_figures.hpp"

namespace waymark::study {

/// The runs of a sweep that differ in nothing but their seed.
struct SweepGroup {
  std::vector<std::string> values;  ///< of the axes but `seed`, in their order
  std::size_t runs = 0;             ///< with figures
  std::size_t failed = 0;           ///< without
  std::size_t diverged = 0;         ///< with a position RMSE above that of odometry alone
  Figures median{};                 ///< over the runs that have the figure; NaN: none has
  Figures low{};                    ///< first quartile
  Figures high{};                   ///< third quartile
};

struct SweepSummary {
  std::vector<std::string> axes;  ///< all but `seed`
  std::vector<SweepGroup> groups;
};

/// Groups in the order in which they come up. Quantiles interpolate linearly. O(n log n).
[[nodiscard]] SweepSummary summarise(const SweepPlan& plan, std::span<const SweepRow> rows);

/// A row of text per group: what it is, and medians of the main figures.
[[nodiscard]] std::string to_text(const SweepSummary& summary);

/// The place of a figure in Figures; the name must be one of kFigureNames.
[[nodiscard]] std::size_t figure_index(std::string_view name);

}  // namespace waymark::study
