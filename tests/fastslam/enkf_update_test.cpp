#include "waymark/fastslam/enkf_update.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "waymark/core/random.hpp"

namespace waymark::fastslam {
namespace {

using kernels::LandmarkForm;
using kernels::ObservationKind;

constexpr int kEnsemble = 2000;
constexpr double kSigma = 0.3;  // of the robots' places along x
constexpr float kWorld = 1000.0F;

struct Moments {
  double mean = 0.0;
  double variance = 0.0;
};

/// Robots that look along x at a landmark whose place all know; some landmarks moved with the robot that saw
/// them, another has nothing to do with it.
class EnkfUpdateTest : public testing::Test {
 protected:
  EnkfUpdateTest() {
    store_.add(LandmarkForm::kPoint, origin_m_);  // 0: seen, known
    store_.add(LandmarkForm::kPoint, origin_m_);  // 1: moved with the robot
    store_.add(LandmarkForm::kPoint, origin_m_);  // 2: independent
    store_.add(LandmarkForm::kRay, origin_m_);    // 3: its anchor moved with the robot
    RandomStream random(1, StreamPurpose::kWorld);
    for (int i = 0; i < kEnsemble; ++i) {
      const double x = kSigma * random.normal();
      particles_.set_pose(i, {kWorld + x, 0.0, 0.0});
      set(0, i, 5.0);
      set(1, i, 2.0 + 0.5 * x);
      set(2, i, 7.0 + 0.2 * random.normal());
      set(3, i, 0.1);
      store_.view(3, origin_m_).anchor_x[i] = static_cast<float>(x);
    }
  }

  void set(int landmark, int i, double a) {
    const auto& m = store_.view(landmark, origin_m_).modes->gaussian;
    m.a[i] = static_cast<float>(a);
    m.aa[i] = m.bb[i] = 1e-4F;
  }

  /// A range to landmark 0, with this noise in each particle.
  void see(float range_m, double noise, double information_weight = 1.0) {
    const kernels::LandmarkObservation observation{
        {ObservationKind::kRange, range_m}, {}, store_.view(0, origin_m_)};
    const double spread = robot_x().variance * kEnsemble / (kEnsemble - 1.0);
    enkf_.assimilate({observation, false, spread + noise, information_weight}, belief_);
  }

  /// Over the particles that weigh anything.
  template <class Value>
  [[nodiscard]] Moments moments(const Value& value) const {
    const auto mean_over = [&](const auto& term) {
      double sum = 0.0;
      for (int i = 0; i < kEnsemble; ++i) {
        const double w = particles_.weights()[static_cast<std::size_t>(i)];
        if (w > 0.0) sum += w * term(i);
      }
      return sum;
    };
    const double mean = mean_over(value);
    return {mean, mean_over([&](int i) { return std::pow(value(i) - mean, 2); })};
  }
  [[nodiscard]] Moments robot_x() const {
    return moments([this](int i) { return particles_.pose(i).x_m - kWorld; });
  }
  [[nodiscard]] Moments landmark_x(int k) const {
    return moments([this, k](int i) { return store_.at(k, i).mean.x() - kWorld; });
  }

  Belief belief_{{.particles = kEnsemble, .initial = {.T_world_robot = {kWorld, 0.0, 0.0}}}, {}, 1};
  Eigen::Vector2d origin_m_ = belief_.origin_m();
  Particles& particles_ = belief_.particles;
  LandmarkStore& store_ = belief_.store;
  EnkfUpdate enkf_{belief_.blocks};
};

TEST_F(EnkfUpdateTest, MovesMeansAsTheKalmanFilterDoes) {
  const Moments robot = robot_x();
  const Moments landmark = landmark_x(1);
  constexpr double kNoise = 0.04;
  see(4.6F, kNoise);  // 0.4 nearer than a robot at 0 would be
  const double gain = robot.variance / (robot.variance + kNoise);
  EXPECT_NEAR(robot_x().mean, robot.mean + gain * (0.4 - robot.mean), 1e-3);
  EXPECT_NEAR(landmark_x(1).mean, landmark.mean + 0.5 * gain * (0.4 - robot.mean), 1e-3);
}

TEST_F(EnkfUpdateTest, PartOfTheInformationIsAnObservationOfMoreNoise) {
  const Moments robot = robot_x();
  constexpr double kNoise = 0.04;
  see(4.6F, kNoise, 0.25);
  const double gain = robot.variance / (robot.variance + kNoise / 0.25);
  EXPECT_NEAR(robot_x().mean, robot.mean + gain * (0.4 - robot.mean), 1e-3);
}

TEST_F(EnkfUpdateTest, LeavesTheSpreadOfHalfTheGain) {
  const Moments robot = robot_x();
  constexpr double kNoise = 0.09;
  see(5.0F, kNoise);
  // (1 - K/2)^2 P, at least the posterior (1 - K) P.
  const double gain = robot.variance / (robot.variance + kNoise);
  EXPECT_NEAR(robot_x().variance, std::pow(1.0 - 0.5 * gain, 2) * robot.variance, 1e-3);
}

TEST_F(EnkfUpdateTest, LeavesAloneWhatHasNothingToDoWithIt) {
  const Moments before = landmark_x(2);
  see(4.0F, 1e-4);
  EXPECT_NEAR(landmark_x(2).mean, before.mean, 0.02);
  EXPECT_NEAR(landmark_x(2).variance, before.variance, 0.01 * before.variance);
  EXPECT_EQ(particles_.pose(3).y_m, 0.0);
  EXPECT_EQ(particles_.pose(3).theta_rad, 0.0);
}

TEST_F(EnkfUpdateTest, CarriesAnchorsAlong) {
  see(4.6F, 1e-4);
  const auto view = store_.view(3, origin_m_);
  for (int i = 0; i < kEnsemble; ++i) EXPECT_NEAR(view.anchor_x[i], particles_.pose(i).x_m - kWorld, 1e-3);
  EXPECT_FLOAT_EQ(view.modes->gaussian.a[7], 0.1F);
}

/// A hypothesis that a particle has dropped is what is left of memory.
TEST_F(EnkfUpdateTest, DroppedHypothesesDoNotSpreadToOthers) {
  store_.add(LandmarkForm::kRing, origin_m_, 2);
  const auto view = store_.view(4, origin_m_);
  for (int i = 0; i < kEnsemble; ++i) {
    const double x = particles_.pose(i).x_m - kWorld;
    view.anchor_x[i] = static_cast<float>(x);
    view.anchor_y[i] = 0.0F;
    for (std::size_t k = 0; k < 2; ++k) {
      const bool dropped = i % 4 == static_cast<int>(k);  // the first particle among them
      const float garbage =
          i % 8 < 4 ? std::numeric_limits<float>::quiet_NaN() : std::numeric_limits<float>::infinity();
      view.modes[k].gaussian.a[i] = dropped ? garbage : static_cast<float>(0.1 * x);
      view.modes[k].log_weight[i] = dropped ? kernels::kDeadMode : std::log(0.5F);
    }
  }
  const Moments robot = robot_x();
  see(4.6F, 0.04);
  for (std::size_t k = 0; k < 2; ++k) {
    double mean = 0.0;
    for (int i = 0; i < kEnsemble; ++i) {
      if (i % 4 == static_cast<int>(k)) continue;
      ASSERT_TRUE(std::isfinite(view.modes[k].gaussian.a[i])) << i;
      mean += static_cast<double>(view.modes[k].gaussian.a[i]) / (0.75 * kEnsemble);
    }
    // Those who have it show how it varies, the others do not vary: three quarters of 0.1 times the robots'.
    EXPECT_NEAR(mean - 0.1 * robot.mean, 0.075 * (robot_x().mean - robot.mean), 3e-3) << k;
  }
  EXPECT_TRUE(std::isfinite(robot_x().mean));
}

TEST_F(EnkfUpdateTest, DoesNothingWithoutParticlesToCompare) {
  for (int i = 3; i < kEnsemble; ++i) particles_.weights()[static_cast<std::size_t>(i)] = 0.0;
  for (int i = 0; i < 3; ++i) particles_.weights()[static_cast<std::size_t>(i)] = 1.0 / 3.0;
  const Pose2 before = particles_.pose(0);
  see(4.0F, 1e-4);
  EXPECT_EQ(particles_.pose(0), before);
}

TEST_F(EnkfUpdateTest, DeadParticlesDoNotSpoilIt) {
  auto weights = particles_.weights();
  for (std::size_t i = 0; i < kEnsemble; ++i) weights[i] = i % 2 == 0 ? 2.0 / kEnsemble : 0.0;
  for (int i = 1; i < kEnsemble; i += 2) particles_.set_pose(i, {std::nan(""), 0.0, 0.0});
  see(4.6F, 1e-4);
  EXPECT_NEAR(robot_x().mean, 0.4, 0.01);
}

}  // namespace
}  // namespace waymark::fastslam
