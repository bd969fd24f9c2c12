#pragma once

#include "waymark/core/trajectory.hpp"

#include "workbench/eval/truth_track.hpp"
#include "workbench/report/report.hpp"

namespace waymark {

/// A path, moved into the frame of a page, with times since `start`, so that axes read in seconds and not in
/// Unix time.
[[nodiscard]] PathSeries path_series(const Trajectory& trajectory, const Pose2& T_page_path, Stamp start);
[[nodiscard]] PathSeries path_series(const eval::TruthTrack& truth, const Pose2& T_page_path, Stamp start);

}  // namespace waymark
