#include "waymark/ekf/compressed_state.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "support/allocation_counter.hpp"
#include "support/matrix_near.hpp"
#include "support/poses.hpp"
#include "waymark/core/gaussian.hpp"
#include "waymark/core/random.hpp"

namespace waymark::ekf {
namespace {

using test::matrix_near;

/// A robot that wanders along a row of landmarks and back. It sees some of the nearest ones.
class Wanderer {
 public:
  explicit Wanderer(int dimension, std::uint64_t seed = 7) : dimension_(dimension), random_(seed, StreamPurpose::kWorld) {}

  Motion move() {
    const Pose2 increment{random_.uniform(0.0, 0.3), random_.uniform(-0.02, 0.02), random_.uniform(-0.2, 0.2)};
    return {increment, test::random_covariance<3>(random_, 1e-4)};
  }

  /// Sightings of no particular sensor, of landmarks about the place where step `step` finds the robot.
  std::vector<Sighting> look(int step, int landmarks, double innovation = 0.05) {
    const double place = 0.5 - 0.5 * std::cos(0.011 * step);
    std::vector<Sighting> sightings;
    const int count = 1 + static_cast<int>(random_.uniform() * 6);
    for (int i = 0; i < count; ++i) {
      const int near = static_cast<int>(place * landmarks) + static_cast<int>(random_.uniform(-8.0, 8.0));
      const bool stray = random_.uniform() < 0.01;  // a landmark from anywhere
      const int landmark = stray ? static_cast<int>(random_.uniform() * landmarks) : std::clamp(near, 0, landmarks - 1);
      sightings.push_back(sight(landmark, innovation));
    }
    return sightings;
  }

  Eigen::Vector3d position() { return {random_.uniform(-9.0, 9.0), random_.uniform(-9.0, 9.0), random_.uniform(-1.0, 1.0)}; }

  Eigen::Matrix3d jacobian() {
    Eigen::Matrix3d G = Eigen::Matrix3d::Identity();
    for (auto& entry : G.reshaped()) entry += 0.3 * random_.normal();
    return G;
  }

  RandomStream& random() { return random_; }

 private:
  Sighting sight(int landmark, double innovation) {
    Sighting s;
    s.landmark = landmark;
    s.rows = random_.uniform() < 0.3 ? 1 : 2;
    s.nu = Eigen::Vector2d(random_.normal(), random_.normal()) * innovation;
    for (auto& entry : s.H_pose.reshaped()) entry = random_.normal();
    for (auto& entry : s.H_landmark.reshaped()) entry = random_.normal();
    if (dimension_ == 2) s.H_landmark.col(2).setZero();
    s.R = test::random_covariance<2>(random_, 0.05);
    return s;
  }

  int dimension_;
  RandomStream random_;
};

constexpr int kCapacity = 300;
constexpr Compression kSmallRegions{48, 48};

struct Case {
  int dimension;
  Consistency consistency;
};

/// The same operations on a compressed and on a whole state.
class CompressedAgainstWhole : public testing::TestWithParam<Case> {
 protected:
  CompressedAgainstWhole()
      : compressed_(GetParam().dimension, kCapacity, GetParam().consistency, kSmallRegions),
        whole_(GetParam().dimension, kCapacity, GetParam().consistency),
        wanderer_(GetParam().dimension) {}

  void step(int step, double innovation = 0.05) {
    const Motion motion = wanderer_.move();
    compressed_.predict(motion);
    whole_.predict(motion);
    const double what = wanderer_.random().uniform();
    if (whole_.landmarks() < kCapacity && (what < 0.35 || whole_.landmarks() == 0)) return add();
    if (what > 0.97) return remove(static_cast<int>(wanderer_.random().uniform() * whole_.landmarks()));
    const auto sightings = wanderer_.look(step, whole_.landmarks(), innovation);
    for (const Sighting& s : sightings)
      EXPECT_TRUE(matrix_near(compressed_.innovation_covariance(s), whole_.innovation_covariance(s), tolerance_));
    ASSERT_TRUE(compressed_.update(sightings));
    ASSERT_TRUE(whole_.update(sightings));
  }

  void add() {
    const Eigen::Vector3d position = wanderer_.position();
    const Eigen::Matrix3d G = wanderer_.jacobian();
    const Eigen::Matrix3d noise = test::random_covariance<3>(wanderer_.random(), 0.01);
    ASSERT_EQ(compressed_.add(position, G, noise), whole_.add(position, G, noise));
  }

  void remove(int index) {
    compressed_.remove(index);
    whole_.remove(index);
  }

  void expect_equal() {
    ASSERT_EQ(compressed_.landmarks(), whole_.landmarks());
    EXPECT_TRUE(matrix_near(compressed_.mean(), whole_.mean(), tolerance_));
    EXPECT_TRUE(matrix_near(compressed_.covariance(), whole_.covariance(), tolerance_));
    for (int i = 0; i < whole_.landmarks(); ++i) {
      EXPECT_TRUE(matrix_near(compressed_.landmark_covariance(i), whole_.landmark_covariance(i), tolerance_));
      EXPECT_TRUE(matrix_near(compressed_.linearization_landmark(i), whole_.linearization_landmark(i), tolerance_));
    }
  }

  double tolerance_ = 1e-9;
  CompressedState compressed_;
  State whole_;
  Wanderer wanderer_;
};

TEST_P(CompressedAgainstWhole, StaysEqualOverThousandsOfStepsAndManyRegions) {
  // The invariant filter turns the rest of the map to first order only: with innovations of zero nothing is turned.
  const double innovation = GetParam().consistency == Consistency::kInvariant ? 0.0 : 0.05;
  for (int i = 0; i < 3000; ++i) {
    step(i, innovation);
    if (i % 157 == 0) expect_equal();
    if (HasFailure()) FAIL() << "at step " << i;
  }
  EXPECT_GT(compressed_.closed_regions(), 10);
}

INSTANTIATE_TEST_SUITE_P(AllModes, CompressedAgainstWhole,
                         testing::Values(Case{2, Consistency::kStandard}, Case{2, Consistency::kInvariant},
                                         Case{2, Consistency::kFej}, Case{3, Consistency::kStandard},
                                         Case{3, Consistency::kInvariant}, Case{3, Consistency::kFej}));

}  // namespace
}  // namespace waymark::ekf
