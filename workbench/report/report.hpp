#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "waymark/core/pose2.hpp"
#include "waymark/core/result.hpp"

#include "workbench/run/image_strip.hpp"

namespace waymark {

// What the report page shows. Series are columns of equal length, in the order of time, of any length; an
// empty column or series is one that the run does not have, and simply does not appear. Positions are in the
// world frame.

/// A path; headings may be missing.
struct PathSeries {
  std::vector<double> t_s;
  std::vector<double> x_m;
  std::vector<double> y_m;
  std::vector<double> theta_rad;
};

/// Odometry alone, with its distance from the truth at stamps of its own.
struct DeadReckoningSeries {
  PathSeries path;
  std::vector<double> error_t_s;
  std::vector<double> error_m;
};

struct ReportedTrueLandmark {
  std::string id;
  double x_m = 0.0;
  double y_m = 0.0;
};

struct ReportedLandmark {
  std::string id;
  double x_m = 0.0;
  double y_m = 0.0;
  double sxx_m2 = 0.0;
  double sxy_m2 = 0.0;
  double syy_m2 = 0.0;
  std::int64_t observations = 0;
};

/// Estimate minus truth, anchored at the true start pose, with the filter's own standard deviations.
struct ErrorSeries {
  std::vector<double> t_s;
  std::vector<double> x_m;
  std::vector<double> y_m;
  std::vector<double> heading_deg;
  std::vector<double> position_m;
  std::vector<double> sigma_x_m;
  std::vector<double> sigma_y_m;
  std::vector<double> sigma_heading_deg;
  std::vector<double> nees;  ///< of the pose, 3 dof
};

/// One entry per observation that was compared with a landmark.
struct InnovationSeries {
  std::vector<double> t_s;
  std::vector<double> nis;
  std::vector<int> dof;
  std::vector<bool> accepted;
  std::vector<std::string> landmark;
  double gate = 0.0;  ///< largest NIS that is accepted; 0: no gate
};

struct StepSeries {
  std::vector<double> t_s;
  std::vector<double> us;
  std::optional<double> budget_us;
};

struct ReportedBlock {
  std::string name;
  std::int64_t calls = 0;
  double mean_us = 0.0;
  double per_frame_us = 0.0;
  std::optional<double> article_per_frame_us;  ///< published for the same block
};

/// Images of the run with what was looked for in them.
struct ImageStripSeries {
  std::vector<double> t_s;
  std::vector<StripFrame> frames;
};

/// One run of a filter. Its path and landmarks are anchored at the true start pose where there is a truth.
struct RunData {
  std::string name;    ///< as shown: "EKF-SLAM"
  std::string filter;  ///< as in the config: "ekf"
  std::string command;
  std::string config_yaml;
  PathSeries path;
  PathSeries smoothed;             ///< by the whole log, where that was asked for
  std::optional<Pose2> alignment;  ///< moves the anchored estimate to its best fit with the truth
  std::vector<ReportedLandmark> landmarks;
  ErrorSeries errors;
  InnovationSeries innovations;
  StepSeries steps;
  std::vector<ReportedBlock> blocks;
  ImageStripSeries image_strip;
  std::string metrics_json;  ///< the text of metrics.json
  std::vector<std::string> notes;
};

struct ReportData {
  std::string title;
  std::string subtitle;
  std::string version;
  std::string input;
  PathSeries truth;
  std::vector<ReportedTrueLandmark> truth_landmarks;
  DeadReckoningSeries dead_reckoning;
  std::vector<RunData> runs;  ///< over the same log
};

/// The report as one HTML file that needs nothing else and asks no network. Long series are thinned to about
/// 4000 points that keep their extremes.
[[nodiscard]] std::string render_report(const ReportData& data);

[[nodiscard]] Result<void> write_report(const ReportData& data, const std::filesystem::path& path);

}  // namespace waymark
