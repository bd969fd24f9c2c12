#include "workbench/report/path_series.hpp"

#include <limits>

namespace waymark {

PathSeries path_series(const Trajectory& trajectory, const Pose2& T_page_path, Stamp start) {
  PathSeries path;
  for (const auto& point : trajectory) {
    const Pose2 pose = T_page_path * point.pose;
    path.t_s.push_back(to_seconds(point.stamp - start));
    path.x_m.push_back(pose.x_m);
    path.y_m.push_back(pose.y_m);
    path.theta_rad.push_back(pose.theta_rad);
  }
  return path;
}

PathSeries path_series(const eval::TruthTrack& truth, const Pose2& T_page_path, Stamp start) {
  constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  PathSeries path;
  for (const auto& [stamp, sample] : truth.samples()) {
    const Pose2 pose = T_page_path * Pose2{sample.x_m, sample.y_m, sample.theta_rad.value_or(kUnknown)};
    path.t_s.push_back(to_seconds(stamp - start));
    path.x_m.push_back(pose.x_m);
    path.y_m.push_back(pose.y_m);
    path.theta_rad.push_back(pose.theta_rad);
  }
  return path;
}

}  // namespace waymark
