#include "workbench/live/monitor_state.hpp"

#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

#include "waymark/core/angle.hpp"

#include "workbench/logs/json_text.hpp"

namespace waymark::live {
namespace {

using Json = nlohmann::ordered_json;

double rounded(double value, double step) { return std::round(value / step) * step; }
double in_mm(double value_m) { return rounded(value_m, 1e-3); }

/// Semi-axes and angle of one standard deviation.
struct Ellipse {
  double major_m;
  double minor_m;
  double angle_rad;
};

Ellipse ellipse_of(const Eigen::Matrix2d& P) {
  const double mean = 0.5 * (P(0, 0) + P(1, 1)), difference = 0.5 * (P(0, 0) - P(1, 1));
  const double radius = std::hypot(difference, P(0, 1));
  return {std::sqrt(std::max(mean + radius, 0.0)), std::sqrt(std::max(mean - radius, 0.0)),
          0.5 * std::atan2(P(0, 1), difference)};
}

Json pose_json(const StampedPose& pose) {
  const Pose2& T = pose.estimate.T_world_robot;
  const Eigen::Matrix3d& P = pose.estimate.covariance;
  const Ellipse ellipse = ellipse_of(P.topLeftCorner<2, 2>());
  return {{"x_m", in_mm(T.x_m)},
          {"y_m", in_mm(T.y_m)},
          {"theta_rad", rounded(T.theta_rad, 1e-4)},
          {"ellipse", {in_mm(ellipse.major_m), in_mm(ellipse.minor_m), rounded(ellipse.angle_rad, 1e-3)}},
          {"heading_sigma_deg", rounded(to_degrees(std::sqrt(std::max(P(2, 2), 0.0))), 1e-2)}};
}

Json landmark_json(const LandmarkEstimate& landmark) {
  const Ellipse ellipse = ellipse_of(landmark.covariance.topLeftCorner<2, 2>());
  return {landmark.id.number,     in_mm(landmark.position_m.x()), in_mm(landmark.position_m.y()),
          in_mm(ellipse.major_m), in_mm(ellipse.minor_m),         rounded(ellipse.angle_rad, 1e-3)};
}

Json stream_json(const StreamSummary& stream) {
  Json json{{"name", stream.name},
            {"received", stream.received},
            {"rate_hz", rounded(stream.rate_hz, 0.1)},
            {"age_ms", rounded(1e3 * stream.age_p50_s, 0.1)},
            {"age_p99_ms", rounded(1e3 * stream.age_p99_s, 0.1)},
            {"damaged", stream.bad},
            {"lost", stream.lost},
            {"replaced", stream.replaced},
            {"fault", stream.fault}};
  if (stream.silent_s) json["silent_s"] = rounded(*stream.silent_s, 0.1);
  return json;
}

}  // namespace

std::string to_json(const MonitorState& state) {
  Json json{{"light", name_of(state.light.level)},
            {"reasons", state.light.reasons},
            {"since_start_s", rounded(state.since_start_s, 0.1)},
            {"late", state.late},
            {"image", state.image},
            {"recording", state.recording},
            {"marks", state.marks}};
  if (state.pose) json["pose"] = pose_json(*state.pose);
  if (state.free_mb) json["free_mb"] = std::round(*state.free_mb);
  if (state.corrections != nullptr)
    json["corrections"] = {{"count", state.corrections->count()},
                           {"p50_ms", rounded(1e3 * state.corrections->quantile_s(0.5), 0.01)},
                           {"p99_ms", rounded(1e3 * state.corrections->quantile_s(0.99), 0.01)},
                           {"missed", state.corrections->count_above(0.033)}};
  if (state.landmarks != nullptr) {
    json["landmarks"] = Json::array();
    for (const LandmarkEstimate& each : *state.landmarks) json["landmarks"].push_back(landmark_json(each));
  }
  json["streams"] = Json::array();
  for (const StreamSummary& each : state.streams) json["streams"].push_back(stream_json(each));
  return json_text(json);
}

void Trail::add(const Pose2& pose) {
  if (count_++ % stride_ != 0) return;
  if (points_.size() == kMost) {
    for (std::size_t i = 0; i < kMost / 2; ++i) points_[i] = points_[2 * i];
    points_.resize(kMost / 2);
    stride_ *= 2;
  }
  points_.push_back(pose);
}

std::string Trail::to_json() const {
  Json json = Json::array();
  for (const Pose2& point : points_) json.push_back({in_mm(point.x_m), in_mm(point.y_m)});
  return json_text(json);
}

}  // namespace waymark::live
