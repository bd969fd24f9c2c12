#include "workbench/calibrate/drift.hpp"

#include "waymark/core/angle.hpp"

#include "workbench/eval/path_alignment.hpp"
#include "workbench/eval/trajectory_error.hpp"

namespace waymark::calibrate {

std::optional<Drift> drift_of(const Trajectory& dead_reckoning, const eval::TruthTrack& reference,
                              const eval::AssociateOptions& options) {
  const auto pairs = eval::associate(dead_reckoning, reference, options);
  const auto anchor = eval::anchor_at_start(pairs);
  const auto fit = eval::fit_path(pairs);
  if (!anchor || !fit) return std::nullopt;
  const auto errors = eval::errors(pairs, anchor->T_truth_estimate);
  Drift drift;
  drift.path_m = eval::travelled_m(pairs).back();
  drift.final_m = errors.back().position_m.norm();
  drift.final_heading_deg = to_degrees(errors.back().heading_rad.value_or(0.0));
  drift.rmse_m = eval::position_rmse_m(errors).value_or(0.0);
  drift.rmse_aligned_m = eval::position_rmse_m(pairs, fit->T_truth_estimate).value_or(0.0);
  return drift;
}

}  // namespace waymark::calibrate
