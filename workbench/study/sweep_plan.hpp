#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "waymark/core/result.hpp"

#include "workbench/run/config.hpp"
#include "workbench/study/axis.hpp"

namespace waymark::study {

/// Many runs over one input: every combination of the values of a block's axes, for every block.
struct SweepPlan {
  std::string input;  ///< as open_input() takes it
  UserSettings user;  ///< what all runs have in common; axes win over it
  std::vector<std::vector<Axis>> blocks;
};

/// One run of a plan: a value for every column, empty where its block has no such axis.
using SweepPoint = std::vector<std::string>;

/// The keys of all axes, `seed` first, then in the order in which they come.
[[nodiscard]] std::vector<std::string> columns(const SweepPlan& plan);

/// All runs, each once: the first column changes slowest, so that any part of the work from the front is
/// balanced over the others.
[[nodiscard]] std::vector<SweepPoint> points(const SweepPlan& plan);

/// The settings of one run.
[[nodiscard]] UserSettings settings(const SweepPlan& plan, const SweepPoint& point);

/// Axes without doubt about their order: no key twice in a block, and not too many runs (a million).
[[nodiscard]] Result<void> check(const SweepPlan& plan);

/// Input, common settings and columns as a number: two plans that differ in it must not share a journal. The
/// values of the axes are not in it, so that a sweep can be continued with more of them.
[[nodiscard]] Result<std::uint64_t> fingerprint(const SweepPlan& plan);

/// The default study: FastSLAM over its number of particles and what it observes, beside the EKF, in the
/// world `study`. Less than three minutes on two cores.
[[nodiscard]] SweepPlan study_plan();

}  // namespace waymark::study
