#include "workbench/report/run_report.hpp"

#include <limits>

#include <fmt/format.h>

#include "workbench/eval/align.hpp"
#include "workbench/report/article_times.hpp"
#include "workbench/report/micros.hpp"
#include "workbench/report/path_series.hpp"
#include "workbench/run/acting_keys.hpp"

namespace waymark {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

/// Report times count from the first pose of the run, so that axes read in seconds and not in Unix time.
class Clock {
 public:
  explicit Clock(const RunResult& result)
      : start_(result.recording.trajectory.empty() ? Stamp{} : result.recording.trajectory.front().stamp) {}
  [[nodiscard]] double operator()(Stamp stamp) const { return to_seconds(stamp - start_); }
  [[nodiscard]] Stamp start() const { return start_; }

 private:
  Stamp start_;
};

/// The map laid on the survey, for logs whose landmarks are all the truth there is.
Pose2 anchor_by_landmarks(const RunResult& result) {
  const auto map = result.recording.filter->snapshot().landmarks;
  std::vector<Eigen::Vector2d> estimated;
  std::vector<Eigen::Vector2d> surveyed;
  for (const auto& match : eval::match_by_number(map, result.log.landmarks)) {
    const TrueLandmark& truth = result.log.landmarks[match.surveyed];
    estimated.emplace_back(map[match.estimated].position_m.head<2>());
    surveyed.emplace_back(truth.x_m, truth.y_m);
  }
  return eval::align_rigid(estimated, surveyed).value_or(Pose2{});
}

/// Where the run's own frame lies in the frame of the truth: start pose on true start pose, where that is
/// known.
Pose2 anchor(const RunResult& result) {
  if (result.evaluation && result.evaluation->anchor) return result.evaluation->anchor->T_truth_estimate;
  return result.log.landmarks.empty() ? Pose2{} : anchor_by_landmarks(result);
}

DeadReckoningSeries dead_reckoning_of(const RunResult& result, const Clock& clock) {
  DeadReckoningSeries series;
  series.path = path_series(result.recording.dead_reckoning, anchor(result), clock.start());
  eval::AssociateOptions options;
  if (result.log.truth_sensor_m) options.truth_sensor_m = *result.log.truth_sensor_m;
  const auto pairs = eval::associate(result.recording.dead_reckoning, result.truth, options);
  for (const auto& error : eval::errors(pairs, anchor(result))) {
    series.error_t_s.push_back(clock(error.stamp));
    series.error_m.push_back(error.position_m.norm());
  }
  return series;
}

std::vector<ReportedLandmark> landmarks_of(const RunResult& result) {
  const Pose2 T_world_run = anchor(result);
  const Eigen::Matrix2d R = T_world_run.rotation();
  std::vector<ReportedLandmark> landmarks;
  for (const auto& landmark : result.recording.filter->snapshot().landmarks) {
    const Eigen::Vector2d p = T_world_run * Eigen::Vector2d(landmark.position_m.head<2>());
    const Eigen::Matrix2d P = R * landmark.covariance.topLeftCorner<2, 2>() * R.transpose();
    landmarks.push_back(
        {to_string(landmark.id), p.x(), p.y(), P(0, 0), P(0, 1), P(1, 1), landmark.observations});
  }
  return landmarks;
}

ErrorSeries errors_of(const RunResult& result, const Clock& clock) {
  ErrorSeries series;
  if (!result.evaluation) return series;
  for (const auto& error : result.evaluation->series) {
    const Eigen::Vector3d sigma = error.sigma.value_or(Eigen::Vector3d::Constant(kUnknown));
    series.t_s.push_back(clock(error.stamp));
    series.x_m.push_back(error.position_m.x());
    series.y_m.push_back(error.position_m.y());
    series.heading_deg.push_back(to_degrees(error.heading_rad.value_or(kUnknown)));
    series.position_m.push_back(error.position_m.norm());
    series.sigma_x_m.push_back(sigma.x());
    series.sigma_y_m.push_back(sigma.y());
    series.sigma_heading_deg.push_back(to_degrees(sigma.z()));
    series.nees.push_back(error.nees.value_or(kUnknown));
  }
  return series;
}

InnovationSeries innovations_of(const Recording& recording, const Clock& clock) {
  InnovationSeries series;
  for (const auto& [stamp, innovation] : recording.innovations) {
    if (innovation.dof == 0) continue;
    series.t_s.push_back(clock(stamp));
    series.nis.push_back(innovation.nis);
    series.dof.push_back(innovation.dof);
    series.accepted.push_back(innovation.outcome == Outcome::kMatched);
    series.landmark.push_back(to_string(innovation.landmark));
    series.gate = innovation.gate;
  }
  return series;
}

StepSeries steps_of(const Recording& recording, const Clock& clock) {
  StepSeries series;
  for (const auto& step : recording.steps) {
    series.t_s.push_back(clock(step.stamp));
    series.us.push_back(micros(step.cpu));
  }
  if (recording.frame_budget) series.budget_us = micros(*recording.frame_budget);
  return series;
}

/// The times that the article published are shown beside those of its own system only.
std::vector<ReportedBlock> blocks_of(const Metrics& metrics, const Config& config) {
  std::vector<ReportedBlock> blocks;
  for (const auto& row : metrics.blocks) {
    const double total_us = micros(row.total);
    blocks.push_back({std::string(row.name),
                      row.calls,
                      row.calls > 0 ? total_us / static_cast<double>(row.calls) : 0.0,
                      metrics.frames > 0 ? total_us / static_cast<double>(metrics.frames) : 0.0,
                      {}});
    if (const auto article = article_time(row.name); article && is_article_system(config))
      blocks.back().article_per_frame_us = article->per_frame_us;
  }
  return blocks;
}

ImageStripSeries image_strip_of(const Recording& recording, const Clock& clock) {
  ImageStripSeries image_strip{{}, recording.image_strip.frames()};
  for (const StripFrame& frame : image_strip.frames) image_strip.t_s.push_back(clock(frame.stamp));
  return image_strip;
}

/// What moves the anchored estimate to its best fit.
std::optional<Pose2> alignment_of(const RunResult& result) {
  if (!result.evaluation || !result.evaluation->fit || !result.evaluation->anchor) return std::nullopt;
  return result.evaluation->fit->T_truth_estimate * anchor(result).inverse();
}

}  // namespace

ReportData make_report(const RunResult& result, const std::string& command) {
  const Clock clock(result);
  ReportData report;
  report.title = result.log.name;
  report.subtitle = fmt::format("{}, {:.0f} s, {} observations", result.log.format, result.metrics.duration_s,
                                result.metrics.observations);
  report.version = WAYMARK_VERSION;
  report.input = result.input;
  report.truth = path_series(result.truth, {}, clock.start());
  for (const auto& landmark : result.log.landmarks)
    report.truth_landmarks.push_back({to_string(landmark.id), landmark.x_m, landmark.y_m});
  report.dead_reckoning = dead_reckoning_of(result, clock);
  add_run_to(report, result, command);
  return report;
}

void add_run_to(ReportData& report, const RunResult& result, const std::string& command) {
  const Clock clock(result);
  RunData run;
  run.name = filter_name(result.config.filter);
  run.filter = result.metrics.filter;
  run.command = command;
  run.config_yaml = acting_yaml(result.config, result.log, result.recording.odometry);
  run.path = path_series(result.recording.trajectory, anchor(result), clock.start());
  if (result.smoothed) run.smoothed = path_series(result.smoothed->trajectory, anchor(result), clock.start());
  run.alignment = alignment_of(result);
  run.landmarks = landmarks_of(result);
  run.errors = errors_of(result, clock);
  run.innovations = innovations_of(result.recording, clock);
  run.steps = steps_of(result.recording, clock);
  run.blocks = blocks_of(result.metrics, result.config);
  run.image_strip = image_strip_of(result.recording, clock);
  run.metrics_json = to_json(result.metrics);
  run.notes = result.recording.notes;
  if (result.evaluation)
    run.notes.insert(run.notes.end(), result.evaluation->notes.begin(), result.evaluation->notes.end());
  report.runs.push_back(std::move(run));
}

}  // namespace waymark
