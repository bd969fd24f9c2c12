#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "waymark/core/trajectory.hpp"

#include "workbench/calibrate/drift.hpp"
#include "workbench/calibrate/findings.hpp"
#include "workbench/eval/truth_track.hpp"
#include "workbench/run/recording.hpp"

namespace waymark::calibrate {

/// What is to be found out about a robot from a log of its way among landmarks.
enum class Subject {
  kOdometry,
  kMount  ///< where the landmark sensor sits, and the odometry beside it, by which alone that shows
};

/// Dead reckoning before and after, against one reference.
struct DriftPair {
  Drift before, after;
};

/// What a log says of its robot, and what it is worth.
struct LogCalibration {
  std::string input;
  LogInfo log;
  Config config;  ///< with what was found
  std::vector<CalibrationFinding> findings;
  std::vector<std::string> notes;
  int passes = 0;        ///< runs over the log
  bool settled = false;  ///< the last one found what it was run with
  Trajectory dead_reckoning_before, dead_reckoning_after;
  Trajectory smoothed;     ///< by the whole log, with what was found
  eval::TruthTrack truth;  ///< empty where the log has none
  std::optional<DriftPair> drift, drift_from_truth;
};

/// Runs the filter over a log and estimates path, map and the subject from all of it (maximum likelihood,
/// with wide priors where neither log nor user sets smooth.* keys), again with what was found until that
/// moves no more. The error says what the log lacks: landmarks, odometry, motion. `keep_going` is asked now
/// and then with the number of the pass and the part of the log done; false stops.
[[nodiscard]] Result<LogCalibration> calibrate_log(const std::string& input, const UserSettings& user,
                                                   Subject subject, const TimeSpan& span = {},
                                                   const std::function<bool(int, double)>& keep_going = {});

/// As a config that puts in force what was found.
[[nodiscard]] std::string to_yaml(const LogCalibration& calibration);

}  // namespace waymark::calibrate
