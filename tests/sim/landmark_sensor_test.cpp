#include "workbench/sim/landmark_sensor.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include <gtest/gtest.h>

namespace waymark::sim {
namespace {

constexpr int kScans = 10000;

SensorOptions ideal_sensor() {
  SensorOptions options;
  options.range_sigma_m = options.range_sigma_ratio = options.bearing_sigma_deg = 0.0;
  return options;
}

TrueLandmark landmark(std::int32_t number, double x_m, double y_m) {
  return {{LandmarkId::Family::kMarker, number}, x_m, y_m, 0.0};
}

Observations scan_once(const SensorOptions& options, const Pose2& T_world_robot,
                       const std::vector<TrueLandmark>& landmarks, std::uint64_t step = 0) {
  RandomStream random(11, StreamPurpose::kSimulation, step, 1);
  return scan(options, T_world_robot, landmarks, random);
}

/// Mean of `value` over many scans of the same scene.
double mean(const SensorOptions& options, const std::vector<TrueLandmark>& landmarks,
            const std::function<double(const Observations&)>& value) {
  double sum = 0.0;
  for (std::uint64_t i = 0; i < kScans; ++i) sum += value(scan_once(options, {}, landmarks, i));
  return sum / kScans;
}

/// Five standard deviations of the frequency of an event with probability p.
double band(double p) { return 5.0 * std::sqrt(p * (1.0 - p) / kScans); }

const RangeBearing& value_of(const Observation& observation) {
  return std::get<RangeBearing>(observation.value);
}

TEST(SimLandmarkSensor, MeasuresFromItsMount) {
  SensorOptions options = ideal_sensor();
  options.x_m = 1.0;
  options.y_m = 0.5;
  options.yaw_deg = 90.0;
  // The robot at (2, 1) looks along +y; its sensor, ahead and to the left of it at (1.5, 2), along -x.
  const auto seen = scan_once(options, {2.0, 1.0, kPi / 2.0}, {landmark(3, -0.5, 1.5)});
  ASSERT_EQ(seen.size(), 1u);
  EXPECT_NEAR(value_of(seen[0]).range_m, std::hypot(2.0, 0.5), 1e-12);
  EXPECT_NEAR(value_of(seen[0]).bearing_rad, std::atan2(0.5, 2.0), 1e-12);
  EXPECT_EQ(seen[0].id, (LandmarkId{LandmarkId::Family::kMarker, 3}));
  EXPECT_FALSE(seen[0].covariance.has_value());
}

TEST(SimLandmarkSensor, SeesNothingBeyondItsLimits) {
  const double edge_rad = to_radians(ideal_sensor().field_of_view_deg) / 2.0;
  const auto at = [](double range_m, double bearing_rad) {
    return std::vector{landmark(0, range_m * std::cos(bearing_rad), range_m * std::sin(bearing_rad))};
  };
  EXPECT_EQ(scan_once(ideal_sensor(), {}, at(5.35, 0.0)).size(), 1u);
  EXPECT_EQ(scan_once(ideal_sensor(), {}, at(5.37, 0.0)).size(), 0u);
  EXPECT_EQ(scan_once(ideal_sensor(), {}, at(0.34, 0.0)).size(), 1u);
  EXPECT_EQ(scan_once(ideal_sensor(), {}, at(0.33, 0.0)).size(), 0u);
  EXPECT_EQ(scan_once(ideal_sensor(), {}, at(2.0, edge_rad - 1e-6)).size(), 1u);
  EXPECT_EQ(scan_once(ideal_sensor(), {}, at(2.0, edge_rad + 1e-6)).size(), 0u);
  EXPECT_EQ(scan_once(ideal_sensor(), {}, at(2.0, -edge_rad - 1e-6)).size(), 0u);
  EXPECT_EQ(scan_once(ideal_sensor(), {}, at(2.0, kPi)).size(), 0u);
}

TEST(SimLandmarkSensor, SeesAllRoundWithAFullFieldOfView) {
  SensorOptions options = ideal_sensor();
  options.field_of_view_deg = 360.0;
  EXPECT_EQ(scan_once(options, {}, {landmark(0, -1.0, 0.0), landmark(1, 0.0, -1.0)}).size(), 2u);
}

TEST(SimLandmarkSensor, MeasuresWhatItIsToldTo) {
  SensorOptions options = ideal_sensor();
  options.observe = SensorKind::kRange;
  EXPECT_NEAR(std::get<Range>(scan_once(options, {}, {landmark(0, 2.0, 0.5)})[0].value).range_m,
              std::hypot(2.0, 0.5), 1e-12);
  options.observe = SensorKind::kBearing;
  EXPECT_NEAR(std::get<Bearing>(scan_once(options, {}, {landmark(0, 2.0, 0.5)})[0].value).bearing_rad,
              std::atan2(0.5, 2.0), 1e-12);
}

TEST(SimLandmarkSensor, NoiseHasTheStatedVariance) {
  SensorOptions options;
  options.range_sigma_ratio = 0.01;
  const std::vector landmarks{landmark(0, 3.0, 0.0)};
  // Five standard deviations of a sample variance.
  const double relative_band = 5.0 * std::sqrt(2.0 / kScans);
  const double range_variance = std::pow(0.05 + 0.01 * 3.0, 2);
  const double bearing_variance = std::pow(to_radians(1.5), 2);
  EXPECT_NEAR(
      mean(options, landmarks, [](auto& seen) { return std::pow(value_of(seen.at(0)).range_m - 3.0, 2); }),
      range_variance, relative_band * range_variance);
  EXPECT_NEAR(
      mean(options, landmarks, [](auto& seen) { return std::pow(value_of(seen.at(0)).bearing_rad, 2); }),
      bearing_variance, relative_band * bearing_variance);
  EXPECT_NEAR(mean(options, landmarks, [](auto& seen) { return value_of(seen.at(0)).range_m; }), 3.0,
              5.0 * std::sqrt(range_variance / kScans));
}

TEST(SimLandmarkSensor, DropsAsOftenAsStated) {
  SensorOptions options;
  options.drop_probability = 0.3;
  const auto count = [](const Observations& seen) { return static_cast<double>(seen.size()); };
  EXPECT_NEAR(mean(options, {landmark(0, 2.0, 0.0)}, count), 0.7, band(0.7));
}

TEST(SimLandmarkSensor, MisreadsAsOftenAsStatedAndNeverAsItself) {
  SensorOptions options;
  options.misread_probability = 0.2;
  const std::vector landmarks{landmark(0, 2.0, 0.0), landmark(1, -2.0, 0.0), landmark(2, -3.0, 0.0)};
  const auto is_read_as = [](std::int32_t number) {
    return [number](const Observations& seen) { return seen.at(0).id->number == number ? 1.0 : 0.0; };
  };
  EXPECT_NEAR(mean(options, landmarks, is_read_as(0)), 0.8, band(0.8));
  EXPECT_NEAR(mean(options, landmarks, is_read_as(1)), 0.1, band(0.1));
  EXPECT_NEAR(mean(options, landmarks, is_read_as(2)), 0.1, band(0.1));
}

TEST(SimLandmarkSensor, ReportsFalseObservationsAsOftenAsStated) {
  SensorOptions options;
  options.false_probability = 0.4;
  const std::vector out_of_sight{landmark(0, -2.0, 0.0), landmark(1, -3.0, 0.0)};
  const auto count = [](const Observations& seen) { return static_cast<double>(seen.size()); };
  const auto known = [](const Observations& seen) {
    return !seen.empty() && seen[0].id->number < 2 ? 1.0 : 0.0;
  };
  EXPECT_NEAR(mean(options, out_of_sight, count), 0.4, band(0.4));
  EXPECT_NEAR(mean(options, out_of_sight, known), 0.2, band(0.2));
  for (std::uint64_t i = 0; i < 200; ++i) {
    for (const Observation& seen : scan_once(options, {}, out_of_sight, i)) {
      EXPECT_GE(value_of(seen).range_m, options.range_min_m);
      EXPECT_LE(value_of(seen).range_m, options.range_max_m);
      EXPECT_LE(std::abs(value_of(seen).bearing_rad), to_radians(options.field_of_view_deg) / 2.0);
    }
  }
}

TEST(SimLandmarkSensor, ClutterAccompaniesWhatIsReportedWithoutIdentity) {
  SensorOptions options;
  options.clutter_probability = 0.3;
  options.drop_probability = 0.5;
  const std::vector landmarks{landmark(0, 2.0, 0.0), landmark(1, 3.0, 0.0), landmark(2, -2.0, 0.0)};
  const auto named = [](const Observations& seen) {
    return static_cast<double>(std::ranges::count_if(seen, [](const auto& z) { return z.id.has_value(); }));
  };
  const auto clutter = [&](const Observations& seen) {
    return static_cast<double>(seen.size()) - named(seen);
  };
  EXPECT_NEAR(mean(options, landmarks, named), 1.0, 2.0 * band(0.5));
  EXPECT_NEAR(mean(options, landmarks, clutter), 0.3, 2.0 * band(0.15));
}

TEST(SimLandmarkSensor, FalseObservationInAnEmptyWorldHasANewIdentity) {
  SensorOptions options;
  options.false_probability = 1.0;
  const auto seen = scan_once(options, {}, {});
  ASSERT_EQ(seen.size(), 1u);
  EXPECT_GE(seen[0].id->number, 0);
}

TEST(SimLandmarkSensor, NeverReportsANegativeRange) {
  SensorOptions options;
  options.range_min_m = 0.0;
  const std::vector close{landmark(0, 0.01, 0.0)};
  for (std::uint64_t i = 0; i < 200; ++i) {
    for (const Observation& seen : scan_once(options, {}, close, i)) EXPECT_GT(value_of(seen).range_m, 0.0);
  }
}

}  // namespace
}  // namespace waymark::sim
