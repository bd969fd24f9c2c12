#include "workbench/run/check_fit.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "waymark/slam/odometer.hpp"

#include "workbench/run/quantile.hpp"

namespace waymark {
namespace {

/// Two observations of one landmark.
struct Pair {
  std::size_t first;
  std::size_t second;
};

/// What may be wrong in a log, and how its numbers would be right.
struct Mistake {
  std::string what;
  std::function<EventContent(const EventContent&)> odometry = {};
  /// The bearing in the frame of the sensor, given the heading since the start.
  std::function<double(double bearing_rad, double heading_rad)> bearing_rad = {};
  double odometry_unit_m = 1.0;  ///< what a distance of 1 is
  double range_unit_m = 1.0;     ///< likewise a range
};

template <class Content>
std::function<EventContent(const EventContent&)> mend(Content (*mended)(Content)) {
  return [mended](const EventContent& content) -> EventContent {
    const auto* told = std::get_if<Content>(&content);
    return told == nullptr ? content : EventContent(mended(*told));
  };
}

/// Lengths of the odometry are told in that unit.
Mistake odometry_in(double unit_m, const char* what) { return {.what = what, .odometry_unit_m = unit_m}; }

/// Ranges are told in that unit: the odometry is compared in the same one.
Mistake ranges_in(double unit_m, const char* what) {
  return {.what = what, .odometry_unit_m = 1.0 / unit_m, .range_unit_m = unit_m};
}

/// The sensor looks so far to the left of where it is said to look.
Mistake yaw(double yaw_rad, std::string what) {
  return {.what = std::move(what),
          .bearing_rad = [yaw_rad](double bearing_rad, double) { return bearing_rad + yaw_rad; }};
}

std::vector<Mistake> mistakes_of_observations() {
  std::vector<Mistake> all{
      {"bearings are in degrees: bearing_rad has to be in radians",
       {},
       [](double bearing_rad, double) { return to_radians(bearing_rad); }},
      {"bearings are in degrees and clockwise: bearing_rad has to be in radians, counter-clockwise",
       {},
       [](double bearing_rad, double) { return -to_radians(bearing_rad); }},
      odometry_in(1e-3, "lengths of the odometry are in millimetres: they have to be in metres"),
      odometry_in(1e-2, "lengths of the odometry are in centimetres: they have to be in metres"),
      odometry_in(0.3048, "lengths of the odometry are in feet: they have to be in metres"),
      ranges_in(1e-3, "ranges are in millimetres: they have to be in metres"),
      ranges_in(1e-2, "ranges are in centimetres: they have to be in metres"),
      ranges_in(0.3048, "ranges are in feet: set sensor.range_scale=3.2808")};
  for (int degrees = -170; degrees <= 180; degrees += 10) {
    if (degrees == 0) continue;
    const double angle_rad = to_radians(degrees);
    all.push_back(yaw(angle_rad, degrees == 180
                                     ? "the sensor looks backwards or the odometry counts backwards: "
                                       "set sensor.yaw_deg=180, or turn the sign of the speed"
                                     : fmt::format("the sensor looks to the side: set "
                                                   "sensor.yaw_deg to about {} more",
                                                   degrees)));
  }
  for (int degrees = -180; degrees < 180; degrees += 10) {
    const double start_rad = to_radians(degrees);
    all.push_back(
        {"the heading was added to the bearings: bearing_rad has to be relative to the sensor's "
         "forward axis, not to the world",
         {},
         [start_rad](double bearing_rad, double heading_rad) {
           return bearing_rad - heading_rad + start_rad;
         }});
    all.push_back(
        {"the heading was subtracted from the bearings: bearing_rad has to be relative to the "
         "sensor's forward axis",
         {},
         [start_rad](double bearing_rad, double heading_rad) {
           return bearing_rad + heading_rad + start_rad;
         }});
  }
  return all;
}

double opposite(double bearing_rad, double) { return -bearing_rad; }

std::vector<Mistake> mistakes_of(const WheelAngles&) {
  return {
      {"the left wheel has the wrong sign: it counts down while it rolls forward",
       mend<WheelAngles>([](WheelAngles a) {
         return WheelAngles{-a.left_rad, a.right_rad};
       })},
      {"the right wheel has the wrong sign: it counts down while it rolls forward",
       mend<WheelAngles>([](WheelAngles a) {
         return WheelAngles{a.left_rad, -a.right_rad};
       })},
      {"both wheels have the wrong sign: they count down while they roll forward",
       mend<WheelAngles>([](WheelAngles a) {
         return WheelAngles{-a.left_rad, -a.right_rad};
       })},
      {"the left and the right wheel are exchanged and have the wrong sign",
       mend<WheelAngles>([](WheelAngles a) {
         return WheelAngles{-a.right_rad, -a.left_rad};
       })},
      {"the wheel angles are in degrees: they have to be in radians", mend<WheelAngles>([](WheelAngles a) {
         return WheelAngles{to_radians(a.left_rad), to_radians(a.right_rad)};
       })},
      {"the left and the right wheel are exchanged (input.left_joint and input.right_joint name those of a "
       "bag), or bearings are clockwise: they have to be counter-clockwise",
       {},
       opposite}};
}

std::vector<Mistake> mistakes_of(const Velocity&) {
  return {{"turn rates are in degrees per second: w_radps has to be in radians per second",
           mend<Velocity>([](Velocity u) {
             return Velocity{u.v_mps, to_radians(u.w_radps)};
           })},
          {"speeds and turn rates both have the wrong sign", mend<Velocity>([](Velocity u) {
             return Velocity{-u.v_mps, -u.w_radps};
           })},
          {"bearings are clockwise, or turn rates are (as in NED): both have to be counter-clockwise",
           {},
           opposite}};
}

std::vector<Mistake> mistakes_of(const Steering&) {
  return {{"steering angles are in degrees: steer_rad has to be in radians", mend<Steering>([](Steering u) {
             return Steering{u.v_mps, to_radians(u.steer_rad)};
           })},
          {"bearings are clockwise, or steering angles are positive to the right: both have to be "
           "counter-clockwise",
           {},
           opposite}};
}

OdometryPose with_heading(OdometryPose pose, double theta_rad) {
  return {{pose.T_odom_robot.x_m, pose.T_odom_robot.y_m, wrap_angle(theta_rad)}};
}

std::vector<Mistake> mistakes_of(const OdometryPose&) {
  using Pose = OdometryPose;
  return {
      {"headings of the odometry are in degrees: theta_rad has to be in radians",
       mend<Pose>([](Pose p) { return with_heading(p, to_radians(p.T_odom_robot.theta_rad)); })},
      {"headings of the odometry are clockwise: theta_rad has to be counter-clockwise from the x axis",
       mend<Pose>([](Pose p) { return with_heading(p, -p.T_odom_robot.theta_rad); })},
      {"headings of the odometry are clockwise from the y axis, as a compass tells them: theta_rad has to be "
       "counter-clockwise from the x axis",
       mend<Pose>([](Pose p) { return with_heading(p, 0.5 * kPi - p.T_odom_robot.theta_rad); })},
      {"headings of the odometry are counted from the y axis: theta_rad has to be counted from the x axis",
       mend<Pose>([](Pose p) { return with_heading(p, p.T_odom_robot.theta_rad + 0.5 * kPi); })},
      {"headings of the odometry are 90 degrees too large: theta_rad has to be counted from the x axis",
       mend<Pose>([](Pose p) { return with_heading(p, p.T_odom_robot.theta_rad - 0.5 * kPi); })},
      {"bearings are clockwise, or the odometry is (as in NED): both have to be counter-clockwise",
       {},
       opposite}};
}

std::vector<Mistake> mistakes_of(const EventContent& odometry) {
  if (const auto* told = std::get_if<WheelAngles>(&odometry)) return mistakes_of(*told);
  if (const auto* told = std::get_if<Velocity>(&odometry)) return mistakes_of(*told);
  if (const auto* told = std::get_if<Steering>(&odometry)) return mistakes_of(*told);
  if (const auto* told = std::get_if<OdometryPose>(&odometry)) return mistakes_of(*told);
  return {};
}

/// Dead reckoning up to the stamp of each observation, from the origin.
std::vector<Pose2> dead_reckoning(const LogSample& sample, const Config& config, const Mistake& mistake) {
  Odometer odometer(config.odometry, config.pipeline.max_hold_s);
  const Duration shift = duration_from_seconds(config.odometry.response_s + config.sensor.delay_s);
  std::vector<Event> odometry = sample.odometry;
  for (Event& event : odometry) {
    event.stamp = event.stamp + shift;
    if (mistake.odometry) event.content = mistake.odometry(event.content);
  }
  std::vector<Pose2> poses;
  Pose2 pose;
  auto next = odometry.begin();
  for (const auto& observed : sample.observations) {
    for (; next != odometry.end() && next->stamp <= observed.stamp; ++next) {
      pose = pose * odometer.advance(next->stamp, &*next).increment;
      odometer.add(*next);
    }
    if (next != odometry.begin())
      pose = pose * odometer.advance(observed.stamp, next == odometry.end() ? nullptr : &*next).increment;
    poses.push_back(pose);
  }
  return poses;
}

/// Every observation with the first one of the same landmark that is so much later, evenly thinned out.
std::vector<Pair> pairs_of(const LogSample& sample, Duration least, Duration most) {
  constexpr std::size_t kPairs = 2000;
  const auto& all = sample.observations;
  std::map<LandmarkId, std::vector<std::size_t>> of_landmark;
  for (std::size_t i = 0; i < all.size(); ++i)
    if (all[i].id && std::holds_alternative<RangeBearing>(all[i].value)) of_landmark[*all[i].id].push_back(i);
  std::vector<Pair> pairs;
  for (const auto& [id, places] : of_landmark)
    for (auto first = places.begin(), second = first; first != places.end(); ++first) {
      while (second != places.end() && all[*second].stamp - all[*first].stamp < least) ++second;
      if (second == places.end()) break;
      if (all[*second].stamp - all[*first].stamp <= most) pairs.push_back({*first, *second});
    }
  const std::size_t every = pairs.size() / kPairs + 1;
  std::vector<Pair> thinned;
  for (std::size_t i = 0; i < pairs.size(); i += every) thinned.push_back(pairs[i]);
  return thinned;
}

/// What the pairs are judged by.
struct Comparison {
  const LogSample& sample;
  const Config& config;
  std::vector<Pair> pairs;

  [[nodiscard]] const RangeBearing& value(std::size_t place) const {
    return std::get<RangeBearing>(sample.observations[place].value);
  }

  /// A landmark in the robot's frame.
  [[nodiscard]] Eigen::Vector2d landmark(std::size_t place, const Mistake& mistake, const Pose2& pose) const {
    const auto& [range_m, told_rad] = value(place);
    const double bearing_rad = mistake.bearing_rad ? mistake.bearing_rad(told_rad, pose.theta_rad) : told_rad;
    return config.sensor.T_robot_sensor() *
           Eigen::Vector2d(range_m * std::cos(bearing_rad), range_m * std::sin(bearing_rad));
  }

  [[nodiscard]] double apart_m(const std::vector<Pose2>& poses, const Mistake& mistake) const {
    std::vector<double> lengths_m;
    for (const auto& [first, second] : pairs) {
      const Eigen::Vector2d p_first = landmark(first, mistake, poses[first]);
      const Eigen::Vector2d p_second = landmark(second, mistake, poses[second]);
      Pose2 T_second_first = poses[second].inverse() * poses[first];
      T_second_first.x_m *= mistake.odometry_unit_m;
      T_second_first.y_m *= mistake.odometry_unit_m;
      lengths_m.push_back((T_second_first * p_first - p_second).norm());
    }
    return quantile(std::move(lengths_m), 0.5);
  }

  [[nodiscard]] double moved_m() const { return apart_m(std::vector<Pose2>(sample.observations.size()), {}); }

  [[nodiscard]] double noise_m() const {
    std::vector<double> sigmas_m;
    for (const auto& [first, second] : pairs) {
      const Eigen::Matrix2d R = noise_covariance(config.sensor, value(first));
      sigmas_m.push_back(std::sqrt(R(0, 0) + R(1, 1) * value(first).range_m * value(first).range_m));
    }
    return 2.0 * quantile(std::move(sigmas_m), 0.5);
  }
};

bool is_known(const EventContent& odometry, const Config& config) {
  if (std::holds_alternative<WheelAngles>(odometry)) return check(config.odometry.wheels).ok();
  if (std::holds_alternative<Steering>(odometry)) return check(config.odometry.car).ok();
  return true;
}

/// Names the mistake that explains most, if it explains far more than the log as told.
Fit explained(Fit fit, const Comparison& comparison, const std::vector<Pose2>& as_told) {
  auto mistakes = mistakes_of(comparison.sample.odometry.front().content);
  std::ranges::move(mistakes_of_observations(), std::back_inserter(mistakes));
  fit.mended_m = fit.apart_m;
  const Mistake* best = nullptr;
  for (const Mistake& mistake : mistakes) {
    const double apart_m = comparison.apart_m(
        mistake.odometry ? dead_reckoning(comparison.sample, comparison.config, mistake) : as_told, mistake);
    if (apart_m >= fit.mended_m) continue;
    fit.mended_m = apart_m;
    best = &mistake;
  }
  if (best == nullptr || fit.mended_m > 0.25 * fit.apart_m + 0.5 * fit.noise_m) return fit;
  fit.mistake = best->what;
  fit.mended_m *= best->range_unit_m;
  return fit;
}

}  // namespace

std::optional<Fit> fit_of(const LogSample& sample, const Config& config) {
  constexpr std::size_t kLeast = 30;
  if (sample.odometry.empty() || !is_known(sample.odometry.front().content, config)) return std::nullopt;
  Comparison comparison{sample, config, pairs_of(sample, std::chrono::seconds(2), std::chrono::seconds(5))};
  if (comparison.pairs.size() < kLeast) return std::nullopt;
  const auto poses = dead_reckoning(sample, config, {});
  const Fit fit{.apart_m = comparison.apart_m(poses, {}),
                .noise_m = comparison.noise_m(),
                .moved_m = comparison.moved_m()};
  return fit.contradicts() ? explained(fit, comparison, poses) : fit;
}

std::optional<std::string> describe(const Fit& fit) {
  if (!fit.contradicts()) return std::nullopt;
  const std::string contradiction = fmt::format(
      "odometry and observations contradict each other: 2 s later, landmarks are {:.2f} m (median) from "
      "where "
      "the odometry predicts them",
      fit.apart_m);
  if (!fit.mistake.empty())
    return fmt::format("{}; {:.2f} m if {}", contradiction, fit.mended_m, fit.mistake);
  if (fit.apart_m < 4.0 * fit.noise_m || fit.apart_m < 0.8 * fit.moved_m) return std::nullopt;
  return contradiction + "; no known mistake in signs, units or frames explains it";
}

}  // namespace waymark
