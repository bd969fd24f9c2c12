#include "sample_report.hpp"

#include <cmath>
#include <numbers>

namespace waymark {
namespace {

constexpr double kPeriodS = 0.1;
constexpr double kRadiusM = 10.0;

PathSeries circle(std::size_t rows, double radius_m) {
  PathSeries path;
  for (std::size_t i = 0; i < rows; ++i) {
    const double t = kPeriodS * static_cast<double>(i);
    path.t_s.push_back(t);
    path.x_m.push_back(radius_m * std::sin(0.05 * t));
    path.y_m.push_back(radius_m * (1.0 - std::cos(0.05 * t)));
    path.theta_rad.push_back(0.05 * t);
  }
  return path;
}

ErrorSeries errors(std::size_t rows, double size) {
  ErrorSeries series;
  for (std::size_t i = 0; i < rows; ++i) {
    const double t = kPeriodS * static_cast<double>(i);
    const double x = size * std::sin(0.3 * t);
    const double y = size * std::sin(0.2 * t + 1.0);
    series.t_s.push_back(t);
    series.x_m.push_back(x);
    series.y_m.push_back(y);
    series.heading_deg.push_back(20.0 * y);
    series.position_m.push_back(std::hypot(x, y));
    series.sigma_x_m.push_back(0.6 * size);
    series.sigma_y_m.push_back(0.6 * size);
    series.sigma_heading_deg.push_back(12.0 * size);
    series.nees.push_back(3.0 + 2.0 * std::sin(0.5 * t));
  }
  return series;
}

InnovationSeries innovations(std::size_t rows) {
  InnovationSeries series;
  series.gate = 9.21;
  for (std::size_t i = 0; i < rows; ++i) {
    const double nis =
        -2.0 * std::log((static_cast<double>((i * 7919) % rows) + 0.5) / static_cast<double>(rows));
    series.t_s.push_back(kPeriodS * static_cast<double>(i));
    series.nis.push_back(nis);
    series.dof.push_back(2);
    series.accepted.push_back(nis < series.gate);
    series.landmark.push_back(std::to_string(i % 8));
  }
  return series;
}

/// Two images with one landmark of each fate.
ImageStripSeries image_strip() {
  ImageStripSeries series;
  for (int i = 0; i < 2; ++i) {
    StripFrame& frame = series.frames.emplace_back();
    frame.image = GreyImage(64, 48, static_cast<std::uint8_t>(100 + i));
    for (int k = 0; k < 5; ++k) {
      vision::SearchRecord look{.id = {LandmarkId::Family::kCorner, k}, .candidate = k == 4};
      look.result = static_cast<vision::SearchRecord::Result>(k % 4);
      look.predicted_px = Eigen::Vector2d(10.0 * k, 20.0);
      look.S = Eigen::Matrix2d::Identity();
      look.pixel = look.predicted_px + Eigen::Vector2d(0.25, i);
      frame.search_records.push_back(look);
    }
    frame.search_records[2].result = vision::SearchRecord::Result::kFound;
    frame.refused.push_back(frame.search_records[2].id);
    series.t_s.push_back(0.5 * i);
  }
  return series;
}

RunData run(const std::string& name, std::size_t rows, double error_m) {
  RunData run;
  run.name = name;
  run.filter = "ekf";
  run.command = "waymark run sim:circle -o out";
  run.config_yaml = "filter: ekf\n";
  run.path = circle(rows, kRadiusM + error_m);
  run.alignment = Pose2{0.1, -0.1, 0.02};
  for (int i = 0; i < 8; ++i) {
    const double angle = std::numbers::pi / 4.0 * i;
    run.landmarks.push_back(
        {std::to_string(i), 13.0 * std::cos(angle), 10.0 + 13.0 * std::sin(angle), 0.09, 0.02, 0.04, 40 + i});
  }
  run.errors = errors(rows, error_m);
  run.innovations = innovations(rows);
  run.steps = {run.path.t_s, std::vector<double>(rows, 50.0), 33'000.0};
  run.steps.us[rows / 2] = 900.0;
  run.blocks = {{"predict", 900, 2.5, 2.5}, {"correct", 880, 40.0, 39.1}};
  run.image_strip = image_strip();
  run.metrics_json =
      R"({"input": "sim:circle", "observe": "range-bearing", "duration_s": 90.0, "nis_per_dof": 1.02,
    "verdict": {"level": "unsure", "reasons": ["the robot was lost and found again 2 times"]},
    "step_us": {"p50": 50.0, "p99": 80.0}, "truth": {"position_rmse_m": 0.05, "odometry_position_rmse_m": 1.0}})";
  run.notes = {"3 observations came before the first odometry"};
  return run;
}

}  // namespace

ReportData sample_report(std::size_t rows) {
  ReportData data;
  data.title = "Circle";
  data.version = "1.2.3";
  data.input = "sim:circle";
  data.truth = circle(rows, kRadiusM);
  data.truth_landmarks = {{"0", 13.0, 10.0}, {"1", 9.2, 19.2}};
  data.dead_reckoning.path = circle(rows, 1.2 * kRadiusM);
  data.dead_reckoning.error_t_s = data.truth.t_s;
  data.dead_reckoning.error_m = data.truth.t_s;
  data.runs = {run("EKF-SLAM", rows, 0.05), run("FastSLAM", rows, 0.1)};
  return data;
}

}  // namespace waymark
