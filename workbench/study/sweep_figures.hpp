#pragma once

#include <array>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <string_view>

#include "workbench/study/scored_run.hpp"
#include "workbench/study/sweep_plan.hpp"

namespace waymark::study {

/// What a sweep keeps of every run, in this order. NaN: not known.
inline constexpr std::array<std::string_view, 19> kFigureNames{"position_rmse_m",
                                                               "position_rmse_aligned_m",
                                                               "heading_rmse_deg",
                                                               "final_error_m",
                                                               "landmark_rmse_m",
                                                               "landmark_rmse_self_m",
                                                               "landmarks_missed",
                                                               "landmarks_spurious",
                                                               "nees_mean",
                                                               "nees_median",
                                                               "landmark_nees_per_dof",
                                                               "nis_per_dof",
                                                               "odometry_position_rmse_m",
                                                               "step_mean_us",
                                                               "step_p50_us",
                                                               "frobenius_mixture_m2",
                                                               "frobenius_mean_m2",
                                                               "landmarks",
                                                               "wall_s"};

using Figures = std::array<double, kFigureNames.size()>;
inline constexpr double kUnknownFigure = std::numeric_limits<double>::quiet_NaN();

/// A run of a sweep as one row of its table.
struct SweepRow {
  SweepPoint point;
  Figures figures{};
  std::string error;  ///< why there are no figures; empty if there are
  Error::Kind error_kind = Error::Kind::kBadInput;
};

/// Every figure of a finished run. The Frobenius norm is that of the mean over the landmarks of their 2x2
/// covariances: `mixture` of what the filter as a whole claims, `mean` of what its particles claim on average
/// without their spread, as the FastSLAM report has it. Equal for a filter without particles.
[[nodiscard]] Figures figures_of(const ScoredRun& run);

/// Makes one run of a plan; a run that cannot be made gives a row with its error, also where something is
/// thrown, such as when memory runs out. Nothing if `keep_going` said no. Safe to call from several threads.
[[nodiscard]] std::optional<SweepRow> make_run(const SweepPlan& plan, const SweepPoint& point,
                                               const std::function<bool()>& keep_going = {});

/// One line of comma-separated cells: the point, the figures (empty: not known) and the error. Numbers read
/// back to the last bit.
[[nodiscard]] std::string to_csv(const SweepRow& row);
/// The header above such lines.
[[nodiscard]] std::string csv_header(const SweepPlan& plan);

}  // namespace waymark::study
