#include "waymark/ekf/sensor_bias_states.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "support/circle_world.hpp"
#include "support/matrix_near.hpp"
#include "waymark/core/angle.hpp"
#include "waymark/ekf/ekf_slam.hpp"

namespace waymark::ekf {
namespace {

using test::CircleWorld;

SensorErrors example() {
  return {.shared_range_sigma_ratio = 0.02,
          .shared_bearing_sigma_deg = 0.5,
          .bias_range_sigma_ratio = 0.01,
          .bias_bearing_sigma_deg = 0.3,
          .bias_distance_m = 2.0};
}

LandmarkId marker(int number) { return {LandmarkId::Family::kMarker, number}; }

/// The errors of a sensor with a state that has room for them.
struct Fixture {
  explicit Fixture(const SensorErrors& sensor)
      : errors(sensor), state(2, 10, Consistency::kStandard, {}, 1, errors.pairs()) {
    errors.start(state);
  }

  /// z - h of an observation that shows nothing but its errors. The landmark's place is certain.
  void observe(int number, const Eigen::Vector2d& difference) {
    const ObservationBias error = errors.of(marker(number), 1.0);
    LinearizedObservation linearization;
    linearization.nu = difference - state.active().expected(error.terms);
    linearization.errors = error.terms;
    linearization.R = 1e-12 * Eigen::Matrix2d::Identity() + error.unmodelled;
    ASSERT_TRUE(state.update({&linearization, 1}));
  }

  [[nodiscard]] Eigen::Vector2d expected(int number) const {
    return state.active().expected(errors.of(marker(number), 1.0).terms);
  }

  SensorBiasStates errors;
  CompressedState state;
};

TEST(SensorBiasStates, CostNothingWhereThereAreNone) {
  Fixture f({});
  EXPECT_EQ(f.errors.pairs(), 0);
  f.errors.begin_scan();
  f.errors.assign(f.state, marker(1));
  const ObservationBias error = f.errors.of(marker(1), 3.0);
  EXPECT_FALSE(error.terms[0].takes_part());
  EXPECT_FALSE(error.terms[1].takes_part());
  EXPECT_TRUE(error.unmodelled.isZero(0.0));
}

TEST(SensorBiasStates, GrowWithRange) {
  Fixture f(example());
  f.errors.begin_scan();
  f.errors.assign(f.state, marker(1));
  const ObservationBias error = f.errors.of(marker(1), 5.0);
  EXPECT_NEAR(error.terms[0].J(0, 0), 0.1, 1e-15);
  EXPECT_NEAR(error.terms[0].J(1, 1), to_radians(0.5), 1e-15);
  EXPECT_NEAR(error.terms[1].J(0, 0), 0.05, 1e-15);
  EXPECT_NEAR(error.terms[1].J(1, 1), to_radians(0.3), 1e-15);
}

TEST(SensorBiasStates, AreForgottenAlongTheWay) {
  SensorErrors sensor = example();
  sensor.shared_range_sigma_ratio = sensor.shared_bearing_sigma_deg = 0.0;
  Fixture f(sensor);
  f.state.add({1.0, 0.0, 0.0}, Eigen::Matrix3d::Zero(), 1e-12 * Eigen::Matrix3d::Identity());
  f.errors.begin_scan();
  f.errors.assign(f.state, marker(1));
  const Eigen::Vector2d seen(0.02, -0.01);
  f.observe(1, seen);
  EXPECT_NEAR(f.expected(1)[0], seen[0], 1e-6) << "standing still";

  f.errors.drive(3.0);
  f.errors.begin_scan();
  f.errors.assign(f.state, marker(1));
  EXPECT_NEAR(f.expected(1)[0], seen[0] * std::exp(-1.5), 1e-6);
  f.errors.assign(f.state, marker(2));
  EXPECT_NEAR(f.expected(2)[0], 0.0, 1e-12) << "another landmark's are its own";
}

TEST(SensorBiasStates, OfMoreLandmarksThanAreRememberedBecomeNoise) {
  Fixture f(example());
  f.errors.begin_scan();
  const int remembered = f.errors.pairs() - 1;
  for (int number = 0; number <= remembered; ++number) f.errors.assign(f.state, marker(number));
  const ObservationBias first = f.errors.of(marker(0), 2.0);
  EXPECT_TRUE(first.terms[1].takes_part());
  EXPECT_TRUE(first.unmodelled.isZero(0.0));
  const ObservationBias last = f.errors.of(marker(remembered), 2.0);
  EXPECT_FALSE(last.terms[1].takes_part());
  EXPECT_NEAR(last.unmodelled(0, 0), 0.02 * 0.02, 1e-15);

  f.errors.begin_scan();
  f.errors.assign(f.state, marker(remembered));
  EXPECT_TRUE(f.errors.of(marker(remembered), 2.0).terms[1].takes_part())
      << "takes over from one that is not in view";
}

TEST(SensorBiasStates, ScaleAndOffsetOfRangesAndOffsetOfBearingsAreLearntWithinWhatItSaysOfThem) {
  constexpr double kScale = 0.015, kOffset_m = 0.05;
  const double bearing_rad = to_radians(0.8);
  const SensorErrors errors{
      .shared_range_sigma_ratio = 0.1, .shared_range_sigma_m = 0.1, .shared_bearing_sigma_deg = 1.0};
  constexpr int kRuns = 30;
  Eigen::Vector3d d2 = Eigen::Vector3d::Zero();
  for (std::uint64_t seed = 0; seed < kRuns; ++seed) {
    CircleWorld world(seed);
    LandmarkSensor sensor = world.sensor();
    sensor.errors = errors;
    EkfSlam filter({.capacity = 20}, sensor);
    for (int i = 0; i < 300; ++i) {
      filter.predict(world.move());
      std::vector<Observation> scan = world.look();
      for (Observation& each : scan) {
        auto& z = std::get<RangeBearing>(each.value);
        z = {(1.0 + kScale) * z.range_m + kOffset_m, wrap_angle(z.bearing_rad + bearing_rad)};
      }
      filter.correct(scan);
    }
    const auto learnt = filter.calibration();
    ASSERT_TRUE(learnt);
    EXPECT_FALSE(learnt->is_estimated(kSpeedScale));
    const Eigen::Vector3d error =
        learnt->mean.segment<3>(kRangeScale) - Eigen::Vector3d(kScale, kOffset_m, bearing_rad);
    d2 += error.cwiseQuotient(learnt->sigmas.segment<3>(kRangeScale)).cwiseAbs2() / kRuns;
    EXPECT_LT(learnt->sigmas[kRangeOffset], 0.1);
  }
  // 99.9 % band of a mean of 30 chi-square variables of one degree of freedom.
  EXPECT_LT(d2.maxCoeff(), 2.1) << d2.transpose();
  EXPECT_GT(d2.minCoeff(), 0.35);
}

}  // namespace
}  // namespace waymark::ekf
