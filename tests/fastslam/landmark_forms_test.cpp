#include "waymark/fastslam/landmark_forms.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "support/matrix_near.hpp"

namespace waymark::fastslam {
namespace {

using kernels::kDeadMode;
using kernels::LandmarkForm;
using kernels::LandmarkMeasurement;
using kernels::ObservationKind;
using test::matrix_near;

constexpr int kCount = 300;
constexpr LandmarkSensor kSensor{.min_range_m = 0.5, .max_range_m = 10.0, .field_of_view_deg = 90.0};

/// Of the mixture of a first guess, in the numbers of its hypotheses.
struct Mixture {
  double weight = 0.0;
  double mean = 0.0;
  double variance = 0.0;
};

Mixture mixture_of(const FirstForm& first) {
  Mixture m;
  double second = 0.0;
  for (std::size_t k = 0; k < first.modes; ++k) {
    const kernels::FirstMode& mode = first.guess.modes[k];
    const double w = std::exp(static_cast<double>(mode.log_weight));
    const auto value = static_cast<double>(mode.value);
    m.weight += w;
    m.mean += w * value;
    second += w * (value * value + static_cast<double>(mode.variance));
  }
  m.variance = second - m.mean * m.mean;
  return m;
}

double density(const FirstForm& first, double value) {
  double sum = 0.0;
  for (std::size_t k = 0; k < first.modes; ++k) {
    const kernels::FirstMode& mode = first.guess.modes[k];
    const auto variance = static_cast<double>(mode.variance);
    sum += std::exp(static_cast<double>(mode.log_weight) -
                    0.5 * std::pow(value - static_cast<double>(mode.value), 2) / variance) /
           std::sqrt(variance);
  }
  return sum;
}

LandmarkMeasurement bearing_ahead() {
  LandmarkMeasurement seen{ObservationKind::kBearing};
  seen.R_bb = 1e-4F;
  return seen;
}

LandmarkMeasurement range_of(float range_m) {
  LandmarkMeasurement seen{ObservationKind::kRange, range_m};
  seen.R_rr = 0.0025F;
  return seen;
}

/// Of a sensor that misses one landmark in a hundred, on a robot that moved by `step` between its scans.
ViewHistory history_of(const LandmarkSensor& sensor, const Pose2& step) {
  ViewHistory history(sensor);
  for (int scan = 0; scan < 6; ++scan) {
    history.move(step);
    history.scan();
  }
  return history;
}

LandmarkSensor attentive(LandmarkSensor sensor = kSensor) {
  sensor.detection_probability = 0.99;
  return sensor;
}

TEST(FirstForm, WhereNothingIsKnownARayCoversTheSensorsRangeEvenly) {
  for (const ViewHistory& history : {ViewHistory(kSensor), history_of(kSensor, {0.5, 0.0, 0.1})}) {
    const FirstForm first = first_form(bearing_ahead(), kSensor, history);
    EXPECT_EQ(first.form, LandmarkForm::kRay);
    const Mixture mixture = mixture_of(first);
    EXPECT_NEAR(mixture.weight, 1.0, 1e-5);
    EXPECT_NEAR(mixture.mean, std::log(10.0 / 0.5) / 9.5, 1e-3);  // of 1 / d for even d
    // The density of 1 / d is one over the square of it.
    for (double depth_m = 1.0; depth_m < 8.0; depth_m += 0.1)
      EXPECT_NEAR(density(first, 1.0 / depth_m) / density(first, 0.25) * std::pow(4.0 / depth_m, 2), 1.0, 0.4)
          << depth_m;
  }
}

TEST(FirstForm, WhereNothingIsKnownARingCoversTheFieldOfViewEvenly) {
  for (const ViewHistory& history : {ViewHistory(kSensor), history_of(kSensor, {0.5, 0.0, 0.1})}) {
    const FirstForm first = first_form(range_of(4.0F), kSensor, history);
    EXPECT_EQ(first.form, LandmarkForm::kRing);
    const Mixture mixture = mixture_of(first);
    EXPECT_NEAR(mixture.weight, 1.0, 1e-5);
    EXPECT_NEAR(mixture.mean, 0.0, 1e-4);
    for (double phi = -0.6; phi < 0.6; phi += 0.01)
      EXPECT_NEAR(density(first, phi) / density(first, 0.0), 1.0, 0.02) << phi;
    // b sigma_phi^2 / 2 < 0.3 sigma_r for a distance as long as the range, but for the blur of a bearing.
    const double blur = to_radians(kSensor.bearing_sigma_deg) * to_radians(kSensor.bearing_sigma_deg);
    for (std::size_t k = 0; k < first.modes; ++k)
      EXPECT_LT(0.5 * 4.0 * (static_cast<double>(first.guess.modes[k].variance) - 1.1 * blur), 0.3 * 0.05);
  }
}

TEST(FirstForm, WhatEntersByAnEdgeIsAtThatEdge) {
  const LandmarkSensor sensor = attentive();
  const double turn_rad = to_radians(5.0);
  for (const double side : {1.0, -1.0}) {
    const FirstForm first =
        first_form(range_of(4.0F), sensor, history_of(sensor, {0.0, 0.0, side * turn_rad}));
    const Mixture mixture = mixture_of(first);
    EXPECT_NEAR(mixture.weight, 1.0, 1e-5);
    EXPECT_NEAR(side * mixture.mean, to_radians(45.0) - 0.5 * turn_rad, to_radians(2.0));
    EXPECT_LT(std::sqrt(mixture.variance), turn_rad);
  }
}

TEST(FirstForm, WhatEntersByTheReachIsAboutAsFarAway) {
  const LandmarkSensor sensor = attentive();
  const FirstForm first = first_form(bearing_ahead(), sensor, history_of(sensor, {0.5, 0.0, 0.0}));
  ASSERT_EQ(first.modes, 1U);
  EXPECT_EQ(first.guess.modes[0].log_weight, 0.0F);
  const double depth_m = 1.0 / static_cast<double>(first.guess.modes[0].value);
  EXPECT_NEAR(depth_m, 9.75, 0.25);
  const double sigma_m = std::sqrt(static_cast<double>(first.guess.modes[0].variance)) * depth_m * depth_m;
  EXPECT_GT(sigma_m, 0.5 / std::sqrt(12.0));
  EXPECT_LT(sigma_m, 1.0);
}

/// The sensor looks to the left, so driving ahead brings landmarks in by its front edge, not by its reach.
TEST(FirstForm, DirectionsCountFromTheSensorsAxis) {
  LandmarkSensor sensor = attentive();
  sensor.yaw_deg = 90.0;
  const Mixture mixture = mixture_of(first_form(range_of(4.0F), sensor, history_of(sensor, {0.4, 0.0, 0.0})));
  EXPECT_LT(mixture.mean, to_radians(-35.0));
  EXPECT_LT(std::sqrt(mixture.variance), to_radians(6.0));
}

TEST(FirstForm, HypothesesAreBounded) {
  LandmarkMeasurement seen = range_of(1000.0F);
  seen.R_rr = 1e-6F;
  EXPECT_EQ(first_form(seen, {}, ViewHistory({})).modes, kernels::kMaxModes);
  const LandmarkSensor far{.min_range_m = 0.0, .max_range_m = 1e6};
  EXPECT_LE(first_form(bearing_ahead(), far, ViewHistory(far)).modes, kernels::kMaxModes);
  LandmarkSensor blind = kSensor;
  blind.field_of_view_deg = 0.0;
  blind.max_range_m = 0.0;
  for (const LandmarkMeasurement& each : {range_of(0.1F), bearing_ahead()}) {
    const FirstForm first = first_form(each, blind, ViewHistory(blind));
    ASSERT_GE(first.modes, 1U);
    EXPECT_TRUE(std::isfinite(mixture_of(first).mean));
    EXPECT_GT(mixture_of(first).variance, 0.0);
  }
}

TEST(CanTake, PointsTakeAllOthersTheirOwn) {
  for (const ObservationKind kind :
       {ObservationKind::kRangeBearing, ObservationKind::kRange, ObservationKind::kBearing}) {
    EXPECT_TRUE(can_take(LandmarkForm::kPoint, kind));
    EXPECT_EQ(can_take(LandmarkForm::kRay, kind), kind == ObservationKind::kBearing);
    EXPECT_EQ(can_take(LandmarkForm::kRing, kind), kind == ObservationKind::kRange);
  }
  EXPECT_TRUE(can_take(LandmarkForm::kPoint, ObservationKind::kViewEdge));
  EXPECT_TRUE(can_take(LandmarkForm::kRing, ObservationKind::kViewEdge));
  EXPECT_FALSE(can_take(LandmarkForm::kRay, ObservationKind::kViewEdge));
}

/// One landmark of many particles, whose numbers are written by the test.
class LandmarkFormsTest : public testing::Test {
 protected:
  kernels::LandmarkView add(LandmarkForm form, std::size_t modes) {
    landmark_ = store_.add(form, {5.0, 5.0}, modes);
    const auto view = store_.view(landmark_, {0.0, 0.0});
    for (std::size_t k = 0; k < modes; ++k)
      set_mode(view, k, static_cast<float>(k), 4.0F, -std::log(static_cast<float>(modes)));
    for (int i = 0; i < kCount && form != LandmarkForm::kPoint; ++i)
      view.anchor_x[i] = view.anchor_y[i] = 1.0F;
    return view;
  }
  static void set_mode(const kernels::LandmarkView& view, std::size_t k, float a, float b, float log_weight) {
    for (int i = 0; i < kCount; ++i) set_mode(view, k, i, a, b, log_weight);
  }
  static void set_mode(const kernels::LandmarkView& view, std::size_t k, int i, float a, float b,
                       float log_weight) {
    const auto& m = view.modes[k].gaussian;
    m.a[i] = a;
    m.b[i] = b;
    m.aa[i] = 1e-3F;
    m.ab[i] = 0.0F;
    m.bb[i] = 1e-3F;
    if (view.modes[k].log_weight != nullptr) view.modes[k].log_weight[i] = log_weight;
  }

  ParticleBlocks blocks_{kCount};
  Particles particles_{kCount, {5.0, 5.0, 0.0}};
  LandmarkStore store_{blocks_};
  int landmark_ = 0;
};

TEST_F(LandmarkFormsTest, DeadHypothesesAreForgottenAndOthersKept) {
  const auto view = add(LandmarkForm::kRing, 4);
  set_mode(view, 1, 1.0F, 4.0F, kDeadMode);
  tidy_modes(store_, landmark_, particles_, blocks_);
  ASSERT_EQ(store_.modes(landmark_), 3U);
  EXPECT_EQ(store_.view(landmark_, {0.0, 0.0}).modes[1].gaussian.a[7], 2.0F);
}

TEST_F(LandmarkFormsTest, HypothesesThatMeetBecomeOneOfTheSameMoments) {
  const auto view = add(LandmarkForm::kRing, 3);
  set_mode(view, 0, 0.50F, 4.0F, std::log(0.1F));
  set_mode(view, 1, 0.54F, 4.00F, std::log(0.3F));
  set_mode(view, 2, 2.0F, 4.0F, std::log(0.6F));
  const PointGaussian before = store_.at(landmark_, 7);
  tidy_modes(store_, landmark_, particles_, blocks_);
  ASSERT_EQ(store_.modes(landmark_), 2U);
  const auto& merged = store_.view(landmark_, {0.0, 0.0}).modes[0];
  EXPECT_NEAR(merged.gaussian.a[7], 0.53F, 1e-5F);
  EXPECT_NEAR(merged.gaussian.b[7], 4.0F, 1e-5F);
  EXPECT_NEAR(merged.gaussian.aa[7], 1e-3F + 0.25F * 0.75F * 0.04F * 0.04F, 1e-6F);
  EXPECT_NEAR(std::exp(merged.log_weight[7]), 0.4F, 1e-5F);
  EXPECT_TRUE(matrix_near(store_.at(landmark_, 7).mean, before.mean, 1e-3));
  EXPECT_TRUE(matrix_near(store_.at(landmark_, 7).covariance, before.covariance, 1e-2));
}

TEST_F(LandmarkFormsTest, WhenHardlyAnyParticleHasMoreThanOneEachKeepsItsBest) {
  const auto view = add(LandmarkForm::kRing, 2);
  for (int i = 0; i < kCount; ++i) {
    set_mode(view, 0, i, 0.0F, 4.0F, i % 2 == 0 ? 0.0F : kDeadMode);
    set_mode(view, 1, i, 2.0F, 4.0F, i % 2 == 0 ? kDeadMode : 0.0F);
  }
  set_mode(view, 0, 5, 0.0F, 4.0F, std::log(0.3F));  // one still has two
  set_mode(view, 1, 5, 2.0F, 4.0F, std::log(0.7F));
  tidy_modes(store_, landmark_, particles_, blocks_);
  ASSERT_EQ(store_.modes(landmark_), 1U);
  const float* phi = store_.view(landmark_, {0.0, 0.0}).modes[0].gaussian.a;
  EXPECT_EQ(phi[4], 0.0F);
  EXPECT_EQ(phi[5], 2.0F);
  EXPECT_EQ(phi[7], 2.0F);
}

TEST_F(LandmarkFormsTest, AMirrorPairIsKeptUntilSomethingSeparatesIt) {
  const auto view = add(LandmarkForm::kRing, 2);
  set_mode(view, 0, -1.0F, 4.0F, std::log(0.5F));
  set_mode(view, 1, 1.0F, 4.0F, std::log(0.5F));
  tidy_modes(store_, landmark_, particles_, blocks_);
  EXPECT_EQ(store_.modes(landmark_), 2U);
}

TEST_F(LandmarkFormsTest, ARingThatIsSureOfItsDirectionBecomesAPoint) {
  const auto view = add(LandmarkForm::kRing, 1);
  become_point_if_linear(store_, landmark_, particles_, {}, blocks_);  // sigma_phi 0.03
  ASSERT_EQ(store_.form(landmark_), LandmarkForm::kPoint);
  EXPECT_TRUE(matrix_near(store_.at(landmark_, 3).mean, Eigen::Vector2d(10.0, 6.0), 1e-5));
  EXPECT_TRUE(
      matrix_near(store_.at(landmark_, 3).covariance, Eigen::Matrix2d{{1e-3, 0.0}, {0.0, 16e-3}}, 1e-6));
  (void)view;
}

TEST_F(LandmarkFormsTest, ARingThatIsNotSureStaysOne) {
  const auto view = add(LandmarkForm::kRing, 1);
  for (int i = 0; i < 10; ++i) view.modes[0].gaussian.aa[i] = 0.04F;  // more than an exception
  become_point_if_linear(store_, landmark_, particles_, {}, blocks_);
  EXPECT_EQ(store_.form(landmark_), LandmarkForm::kRing);
}

TEST_F(LandmarkFormsTest, ARayBecomesAPointWhenItsDepthIsLinearFromTheSensor) {
  const auto view = add(LandmarkForm::kRay, 1);
  const auto set_sigma_d = [&](float sigma_d) {
    set_mode(view, 0, 0.0F, 0.25F, 0.0F);
    for (int i = 0; i < kCount; ++i) view.modes[0].gaussian.bb[i] = std::pow(sigma_d / 16.0F, 2.0F);
  };
  // From the anchor at (6, 6) along x: the end is at (10, 6), 5.1 m from the sensor at (5, 5), L = 0.77
  // sigma_d.
  set_sigma_d(0.2F);
  become_point_if_linear(store_, landmark_, particles_, {}, blocks_);
  EXPECT_EQ(store_.form(landmark_), LandmarkForm::kRay);
  set_sigma_d(0.1F);
  become_point_if_linear(store_, landmark_, particles_, {}, blocks_);
  ASSERT_EQ(store_.form(landmark_), LandmarkForm::kPoint);
  EXPECT_TRUE(matrix_near(store_.at(landmark_, 3).mean, Eigen::Vector2d(10.0, 6.0), 1e-5));
  EXPECT_NEAR(store_.at(landmark_, 3).covariance(0, 0), 0.01, 1e-5);
}

}  // namespace
}  // namespace waymark::fastslam
