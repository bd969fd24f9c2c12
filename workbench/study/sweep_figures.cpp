#include "workbench/study/sweep_figures.hpp"

#include <algorithm>
#include <cmath>
#include <exception>
#include <utility>

#include "waymark/core/angle.hpp"
#include "waymark/core/failure.hpp"

#include "workbench/logs/number_text.hpp"
#include "workbench/run/recording_figures.hpp"

namespace waymark::study {
namespace {

/// Figures by their names.
class Table {
 public:
  Table() { figures_.fill(kUnknownFigure); }

  void set(std::string_view name, const std::optional<double>& value) {
    const auto place = std::ranges::find(kFigureNames, name) - kFigureNames.begin();
    if (value) figures_.at(static_cast<std::size_t>(place)) = *value;
  }
  [[nodiscard]] const Figures& figures() const { return figures_; }

 private:
  Figures figures_{};
};

void set_truth(const eval::Evaluation& e, Table& table) {
  table.set("position_rmse_m", e.path.position_rmse_m);
  table.set("position_rmse_aligned_m", e.path.position_rmse_aligned_m);
  table.set("heading_rmse_deg", e.path.heading_rmse_deg);
  table.set("final_error_m", e.path.final_error_m);
  table.set("nees_mean", e.nees.mean);
  table.set("nees_median", e.nees.median);
  table.set("odometry_position_rmse_m", e.odometry.position_rmse_m);
  if (!e.map) return;
  table.set("landmark_rmse_m", e.map->rmse_m);
  table.set("landmark_rmse_self_m", e.map->rmse_self_m);
  table.set("landmarks_missed", static_cast<double>(e.map->missed));
  table.set("landmarks_spurious", static_cast<double>(e.map->spurious));
  table.set("landmark_nees_per_dof", e.map->nees_per_dof);
}

void set_landmarks(const std::vector<LandmarkEstimate>& map, Table& table) {
  table.set("landmarks", static_cast<double>(map.size()));
  if (map.empty()) return;
  Eigen::Matrix2d mixture = Eigen::Matrix2d::Zero();
  Eigen::Matrix2d mean = Eigen::Matrix2d::Zero();
  for (const auto& landmark : map) {
    mixture += landmark.covariance.topLeftCorner<2, 2>();
    mean += landmark.within.value_or(landmark.covariance).topLeftCorner<2, 2>();
  }
  table.set("frobenius_mixture_m2", mixture.norm() / static_cast<double>(map.size()));  // Francisco (8)
  table.set("frobenius_mean_m2", mean.norm() / static_cast<double>(map.size()));        // Francisco (8)
}

/// As a cell: without what would end it.
std::string cell(std::string text) {
  std::ranges::replace_if(
      text, [](char c) { return c == ',' || c == '\n' || c == '\r'; }, ';');
  return text;
}

/// What is thrown becomes an error, too.
Result<Figures> try_run(const SweepPlan& plan, const SweepPoint& point,
                        const std::function<bool(double)>& keep_going) {
  try {
    const auto run = run_and_score(plan.input, settings(plan, point), {}, keep_going);
    if (!run) return run.error();
    if (run->recording.error) return *run->recording.error;
    return figures_of(*run);
  } catch (const std::exception& problem) {
    return failure(problem);
  }
}

}  // namespace

Figures figures_of(const ScoredRun& run) {
  Table table;
  if (run.evaluation) set_truth(*run.evaluation, table);
  table.set("nis_per_dof", nis_per_dof(run.recording.innovations));
  const StepTimes steps = step_times(run.recording.steps);
  table.set("step_mean_us", steps.mean_us);
  table.set("step_p50_us", steps.p50_us);
  table.set("wall_s", to_seconds(run.recording.wall));
  set_landmarks(run.recording.filter->snapshot().landmarks, table);
  return table.figures();
}

std::optional<SweepRow> make_run(const SweepPlan& plan, const SweepPoint& point,
                                 const std::function<bool()>& keep_going) {
  bool stopped = false;
  const auto figures = try_run(plan, point, [&](double) {
    stopped = stopped || (keep_going && !keep_going());
    return !stopped;
  });
  if (stopped) return std::nullopt;
  if (figures) return SweepRow{point, *figures, {}};
  SweepRow row{point, {}, cell(figures.error().message), figures.error().kind};
  row.figures.fill(kUnknownFigure);
  return row;
}

std::string to_csv(const SweepRow& row) {
  std::string line;
  for (const auto& value : row.point) line += cell(value) + ",";
  for (const double figure : row.figures) {
    if (!std::isnan(figure)) append_shortest(line, figure);
    line += ',';
  }
  return line + row.error;
}

std::string csv_header(const SweepPlan& plan) {
  std::string header;
  for (const auto& column : columns(plan)) header += column + ",";
  for (const auto& name : kFigureNames) header += std::string(name) + ",";
  return header + "error";
}

}  // namespace waymark::study
