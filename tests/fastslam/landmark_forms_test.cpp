#include "waymark/fastslam/landmark_forms.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "support/matrix_near.hpp"

namespace waymark::fastslam {
namespace {

using kernels::kDeadMode;
using kernels::LandmarkForm;
using kernels::SeenLandmark;
using kernels::SightingKind;
using test::matrix_near;

constexpr int kCount = 300;
constexpr LandmarkSensor kSensor{.min_range_m = 0.5, .max_range_m = 10.0, .field_of_view_deg = 90.0};

TEST(FirstForm, ARayCoversTheSensorsRange) {
  const FirstForm first = first_form({SightingKind::kBearing}, kSensor);
  EXPECT_EQ(first.form, LandmarkForm::kRay);
  const double sigma = std::sqrt(first.guess.rho_var);
  EXPECT_NEAR(first.guess.rho + 2.0 * sigma, 1.0 / 0.5, 1e-6);
  EXPECT_NEAR(first.guess.rho - 2.0 * sigma, 1.0 / 10.0, 1e-6);
}

TEST(FirstForm, ARingCoversTheFieldOfViewEvenly) {
  SeenLandmark seen{SightingKind::kRange, 4.0F};
  seen.R_rr = 0.0025F;
  const FirstForm first = first_form(seen, kSensor);
  EXPECT_EQ(first.form, LandmarkForm::kRing);
  const auto modes = static_cast<double>(first.modes);
  EXPECT_NEAR(modes * first.guess.phi_spacing, 0.5 * kPi, 1e-5);
  // The density that the hypotheses add up to, halfway between two of them and on one.
  const auto density = [&](double phi) {
    double sum = 0.0;
    for (int k = -20; k <= 20; ++k)
      sum += std::exp(-0.5 * std::pow(phi - static_cast<float>(k) * first.guess.phi_spacing, 2) /
                      first.guess.phi_var);
    return sum;
  };
  EXPECT_NEAR(density(0.5 * first.guess.phi_spacing) / density(0.0), 1.0, 0.005);
  // b sigma_phi^2 / 2 < 0.3 sigma_r for a way as long as the range.
  EXPECT_LT(0.5 * 4.0 * first.guess.phi_var, 0.3 * 0.05 * 1.01);
}

TEST(FirstForm, HypothesesAreBounded) {
  SeenLandmark seen{SightingKind::kRange, 1000.0F};
  seen.R_rr = 1e-6F;
  EXPECT_EQ(first_form(seen, {}).modes, kernels::kMaxModes);
  LandmarkSensor blind = kSensor;
  blind.field_of_view_deg = 0.0;
  EXPECT_GE(first_form({SightingKind::kRange, 0.1F, 1.0F, 0.0F, 1.0F}, blind).modes, 1U);
}

TEST(CanTake, PointsTakeAllOthersTheirOwn) {
  for (const SightingKind kind :
       {SightingKind::kRangeBearing, SightingKind::kRange, SightingKind::kBearing}) {
    EXPECT_TRUE(can_take(LandmarkForm::kPoint, kind));
    EXPECT_EQ(can_take(LandmarkForm::kRay, kind), kind == SightingKind::kBearing);
    EXPECT_EQ(can_take(LandmarkForm::kRing, kind), kind == SightingKind::kRange);
  }
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

/// The report's way: on the arc within the field of view, or on the ray within the range.
TEST_F(LandmarkFormsTest, GuessesLieWhereTheSightingAllows) {
  landmark_ = store_.add(LandmarkForm::kPoint, {5.0, 5.0});
  LandmarkSensor sensor = kSensor;
  sensor.yaw_deg = 30.0;
  for (const SightingKind kind : {SightingKind::kRange, SightingKind::kBearing}) {
    const double bearing = kind == SightingKind::kBearing ? 0.2 : 0.0;
    SeenLandmark seen{kind, 4.0F};
    seen.cos_bearing = static_cast<float>(std::cos(bearing + to_radians(30.0)));
    seen.sin_bearing = static_cast<float>(std::sin(bearing + to_radians(30.0)));
    place_by_guess(store_, landmark_, seen, sensor, particles_, {1, StreamPurpose::kInitialisation, 1},
                   blocks_);
    double low = 1e9;
    double high = -1e9;
    for (int i = 0; i < kCount; ++i) {
      const Eigen::Vector2d d = store_.at(landmark_, i).mean - Eigen::Vector2d(5.0, 5.0);
      const double direction = std::atan2(d.y(), d.x()) - to_radians(30.0);
      const double drawn = kind == SightingKind::kRange ? direction : d.norm();
      low = std::min(low, drawn);
      high = std::max(high, drawn);
      EXPECT_NEAR(kind == SightingKind::kRange ? d.norm() : direction,
                  kind == SightingKind::kRange ? 4.0 : 0.2, 1e-5);
    }
    const double from = kind == SightingKind::kRange ? -0.25 * kPi : 0.5;
    const double to = kind == SightingKind::kRange ? 0.25 * kPi : 10.0;
    EXPECT_GE(low, from - 1e-5);
    EXPECT_LE(high, to + 1e-5);
    EXPECT_GT(high - low, 0.95 * (to - from));
  }
}

}  // namespace
}  // namespace waymark::fastslam
