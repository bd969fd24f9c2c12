#include "waymark/ekf/compressed_state.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

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
  explicit Wanderer(int dimension, int bias_pairs = 0, std::uint64_t seed = 7)
      : dimension_(dimension), error_pairs_(bias_pairs), random_(seed, StreamPurpose::kWorld) {}

  Motion move() {
    const Pose2 increment{random_.uniform(0.0, 0.3), random_.uniform(-0.02, 0.02),
                          random_.uniform(-0.2, 0.2)};
    return {increment, test::random_covariance<3>(random_, 1e-4)};
  }

  /// Observations of no particular sensor, of landmarks about the place where step `step` finds the robot.
  std::vector<LinearizedObservation> look(int step, int landmarks, double innovation = 0.05) {
    const double place = 0.5 - 0.5 * std::cos(0.011 * step);
    std::vector<LinearizedObservation> linearizations;
    const int count = 1 + static_cast<int>(random_.uniform() * 6);
    for (int i = 0; i < count; ++i) {
      const int near = static_cast<int>(place * landmarks) + static_cast<int>(random_.uniform(-8.0, 8.0));
      const bool stray = random_.uniform() < 0.01;  // a landmark from anywhere
      const int landmark =
          stray ? static_cast<int>(random_.uniform() * landmarks) : std::clamp(near, 0, landmarks - 1);
      linearizations.push_back(sight(landmark, innovation));
    }
    return linearizations;
  }

  Eigen::Vector3d position() {
    return {random_.uniform(-9.0, 9.0), random_.uniform(-9.0, 9.0), random_.uniform(-1.0, 1.0)};
  }

  Eigen::Matrix3d jacobian() {
    Eigen::Matrix3d G = Eigen::Matrix3d::Identity();
    for (auto& entry : G.reshaped()) entry += 0.3 * random_.normal();
    return G;
  }

  /// Both terms of different pairs, if there are pairs.
  BiasTerms errors() {
    BiasTerms errors;
    for (int k = 0; k < kBiasTerms && k < error_pairs_; ++k) {
      auto& error = errors[static_cast<std::size_t>(k)];
      error.pair = k == 0 ? 0 : 1 + static_cast<int>(random_.uniform() * (error_pairs_ - 1));
      for (auto& entry : error.J.reshaped()) entry = 0.1 * random_.normal();
    }
    return errors;
  }

  RandomStream& random() { return random_; }

 private:
  LinearizedObservation sight(int landmark, double innovation) {
    LinearizedObservation s;
    s.landmark = landmark;
    s.rows = random_.uniform() < 0.3 ? 1 : 2;
    s.nu = Eigen::Vector2d(random_.normal(), random_.normal()) * innovation;
    for (auto& entry : s.H_pose.reshaped()) entry = random_.normal();
    for (auto& entry : s.H_landmark.reshaped()) entry = random_.normal();
    if (dimension_ == 2) s.H_landmark.col(2).setZero();
    s.R = test::random_covariance<2>(random_, 0.05);
    s.errors = errors();
    return s;
  }

  int dimension_;
  int error_pairs_;
  RandomStream random_;
};

constexpr int kCapacity = 300;
constexpr Compression kSmallSubmaps{48, 48};

struct CompressedCase {
  int dimension;
  Consistency consistency;
  int bias_pairs = 0;
};

/// The same operations on a compressed and on a whole state.
class CompressedAgainstWhole : public testing::TestWithParam<CompressedCase> {
 protected:
  CompressedAgainstWhole()
      : compressed_(GetParam().dimension, kCapacity, GetParam().consistency, kSmallSubmaps, 1,
                    GetParam().bias_pairs),
        whole_(GetParam().dimension, kCapacity, GetParam().consistency, 1, GetParam().bias_pairs),
        wanderer_(GetParam().dimension, GetParam().bias_pairs) {}

  void step(int step, double innovation = 0.05) {
    const Motion motion = wanderer_.move();
    compressed_.predict(motion);
    whole_.predict(motion);
    if (GetParam().bias_pairs > 0) propagate();
    const double what = wanderer_.random().uniform();
    if (whole_.landmarks() < kCapacity && (what < 0.35 || whole_.landmarks() == 0)) return add();
    if (what > 0.97) return remove(static_cast<int>(wanderer_.random().uniform() * whole_.landmarks()));
    const auto linearizations = wanderer_.look(step, whole_.landmarks(), innovation);
    for (const LinearizedObservation& s : linearizations)
      EXPECT_TRUE(
          matrix_near(compressed_.innovation_covariance(s), whole_.innovation_covariance(s), tolerance_));
    const bool working = !compressed_.is_up_to_date();
    const bool entering = std::ranges::any_of(
        linearizations, [&](const LinearizedObservation& s) { return !compressed_.is_active(s.landmark); });
    if (working && entering) ++entered_at_work_;
    ASSERT_TRUE(compressed_.update(linearizations));
    ASSERT_TRUE(whole_.update(linearizations));
  }

  void propagate() {
    const int pair = static_cast<int>(wanderer_.random().uniform() * GetParam().bias_pairs);
    const double rho = wanderer_.random().uniform();
    compressed_.propagate_bias(pair, rho);
    whole_.propagate_bias(pair, rho);
  }

  void add() {
    const Eigen::Vector3d position = wanderer_.position();
    const Eigen::Matrix3d G = wanderer_.jacobian();
    const Eigen::Matrix3d noise = test::random_covariance<3>(wanderer_.random(), 0.01);
    const BiasTerms errors = wanderer_.errors();
    ASSERT_EQ(compressed_.add(position, G, noise, errors), whole_.add(position, G, noise, errors));
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
      EXPECT_TRUE(
          matrix_near(compressed_.linearization_landmark(i), whole_.linearization_landmark(i), tolerance_));
    }
  }

  double tolerance_ = 1e-9;
  int entered_at_work_ = 0;  // updates that brought a landmark in while the last submap was being worked on
  CompressedState compressed_;
  State whole_;
  Wanderer wanderer_;
};

TEST_P(CompressedAgainstWhole, StaysEqualOverThousandsOfStepsAndManySubmaps) {
  // The invariant filter turns the rest of the map to first order only: with innovations of zero nothing is
  // turned.
  const double innovation = GetParam().consistency == Consistency::kInvariant ? 0.0 : 0.05;
  for (int i = 0; i < 3000; ++i) {
    step(i, innovation);
    if (i % 397 == 0) expect_equal();
    if (HasFailure()) FAIL() << "at step " << i;
  }
  EXPECT_GT(compressed_.closed_submaps(), 10);
  EXPECT_GT(entered_at_work_, 10);
  EXPECT_TRUE(is_covariance(compressed_.covariance()));
}

INSTANTIATE_TEST_SUITE_P(
    AllModes, CompressedAgainstWhole,
    testing::Values(CompressedCase{2, Consistency::kStandard}, CompressedCase{2, Consistency::kInvariant},
                    CompressedCase{2, Consistency::kFej}, CompressedCase{3, Consistency::kStandard},
                    CompressedCase{3, Consistency::kInvariant}, CompressedCase{3, Consistency::kFej},
                    CompressedCase{2, Consistency::kFej, 3}, CompressedCase{3, Consistency::kStandard, 2},
                    CompressedCase{2, Consistency::kInvariant, 3}));

/// How far the means come apart when all innovations are `scale` times as large.
double invariant_difference(double scale) {
  Wanderer wanderer(2);
  CompressedState compressed(2, kCapacity, Consistency::kInvariant, kSmallSubmaps);
  State whole(2, kCapacity, Consistency::kInvariant);
  double difference = 0.0;
  for (int i = 0; i < 600; ++i) {
    const Motion motion = wanderer.move();
    compressed.predict(motion);
    whole.predict(motion);
    if (i < kCapacity) {
      const Eigen::Vector3d position = wanderer.position();
      const Eigen::Matrix3d G = wanderer.jacobian();
      compressed.add(position, G, 0.01 * Eigen::Matrix3d::Identity());
      whole.add(position, G, 0.01 * Eigen::Matrix3d::Identity());
    }
    const auto linearizations = wanderer.look(i, whole.landmarks(), scale);
    EXPECT_TRUE(compressed.update(linearizations) && whole.update(linearizations));
    difference = std::max(difference, (compressed.mean() - whole.mean()).cwiseAbs().maxCoeff());
  }
  return difference;
}

TEST(CompressedState, InvariantFilterIsTheSameToFirstOrderInTheInnovations) {
  const double coarse = invariant_difference(1e-4);
  const double fine = invariant_difference(0.5e-4);
  EXPECT_GT(coarse, 1e-9);               // well above rounding
  EXPECT_NEAR(coarse / fine, 4.0, 0.5);  // what is left out is of second order
}

/// A run over many submaps in a map that is mapped first.
template <class Filter, class Each>
void wander(Filter& filter, int landmarks, int steps, const Each& each) {
  Wanderer wanderer(2);
  for (int i = 0; i < landmarks; ++i) {
    filter.predict(wanderer.move());
    filter.add(wanderer.position(), wanderer.jacobian(), 0.01 * Eigen::Matrix3d::Identity());
  }
  for (int i = 0; i < steps; ++i) {
    filter.predict(wanderer.move());
    ASSERT_TRUE(filter.update(wanderer.look(i, landmarks)));
    each();
  }
}

TEST(CompressedState, TwoThreadsGiveTheSameBits) {
  std::vector<Eigen::VectorXd> means;
  std::vector<Eigen::MatrixXd> covariances;
  for (const int threads : {1, 2}) {
    CompressedState state(2, kCapacity, Consistency::kInvariant, kSmallSubmaps, threads);
    wander(state, kCapacity, 700, [] {});
    EXPECT_GT(state.closed_submaps(), 10);
    means.push_back(state.mean());
    covariances.push_back(state.covariance());
  }
  EXPECT_EQ(means[0], means[1]);
  EXPECT_TRUE(covariances[0] == covariances[1]);
}

TEST(CompressedState, AllocatesNothingEvenWhenSubmapsChange) {
  for (const int threads : {1, 2}) {
    CompressedState state(2, kCapacity, Consistency::kInvariant, kSmallSubmaps, threads);
    Wanderer wanderer(2);
    wander(state, kCapacity, 10, [] {});
    std::vector<std::vector<LinearizedObservation>> scans;
    for (int i = 0; i < 500; ++i) scans.push_back(wanderer.look(i, kCapacity));
    const Motion motion = wanderer.move();
    const int submaps = state.closed_submaps();
    const test::AllocationCount count;
    for (const auto& scan : scans) {
      state.predict(motion);
      for (const LinearizedObservation& s : scan) (void)state.innovation_covariance(s);
      (void)state.landmark(0);
      (void)state.update(scan);
    }
    EXPECT_EQ(count.allocations(), 0);
    EXPECT_GT(state.closed_submaps(), submaps + 5);
  }
}

TEST(CompressedState, IsTheWholeStateToTheBitWhereItNeedNotCompress) {
  CompressedState compressed(2, 100, Consistency::kInvariant, {48, 100});
  State whole(2, 100, Consistency::kInvariant);
  wander(compressed, 100, 50, [] {});
  wander(whole, 100, 50, [] {});
  compressed.remove(17);
  whole.remove(17);
  EXPECT_EQ(compressed.closed_submaps(), 0);
  EXPECT_EQ(compressed.mean(), whole.mean());
  EXPECT_EQ(compressed.covariance(), whole.covariance());
}

TEST(CompressedState, MakesTheSubmapLargerWhereMoreIsSeenAtOnce) {
  CompressedState compressed(2, 400, Consistency::kStandard, kSmallSubmaps);
  State whole(2, 400, Consistency::kStandard);
  Wanderer wanderer(2);
  for (int i = 0; i < 200; ++i) {
    const Eigen::Vector3d position = wanderer.position();
    const Eigen::Matrix3d G = wanderer.jacobian();
    compressed.add(position, G, 0.01 * Eigen::Matrix3d::Identity());
    whole.add(position, G, 0.01 * Eigen::Matrix3d::Identity());
  }
  for (int step = 0; step < 20; ++step) {
    const Motion motion = wanderer.move();
    compressed.predict(motion);
    whole.predict(motion);
    for (int block = 0; block < 6; ++block) {  // 192 landmarks in one scan
      std::vector<LinearizedObservation> linearizations;
      for (int i = 0; i < State::kMaxObservations; ++i) {
        linearizations.push_back(wanderer.look(0, 200).front());
        linearizations.back().landmark = block * State::kMaxObservations + i;
      }
      ASSERT_TRUE(compressed.update(linearizations));
      ASSERT_TRUE(whole.update(linearizations));
    }
  }
  EXPECT_GT(compressed.active().landmarks(), kSmallSubmaps.submap);
  EXPECT_TRUE(matrix_near(compressed.mean(), whole.mean(), 1e-9));
  EXPECT_TRUE(matrix_near(compressed.covariance(), whole.covariance(), 1e-9));
}

TEST(CompressedState, RefusesAnInnovationCovarianceThatIsNotPositive) {
  CompressedState state(2, kCapacity, Consistency::kInvariant, kSmallSubmaps);
  wander(state, kCapacity, 100, [] {});
  Wanderer wanderer(2);
  const Eigen::VectorXd mean = state.mean();
  const Eigen::MatrixXd covariance = state.covariance();
  for (const double r : {-100.0, std::nan("")}) {
    LinearizedObservation s = wanderer.look(1, kCapacity).front();
    s.R = r * Eigen::Matrix2d::Identity();
    EXPECT_FALSE(state.update({&s, 1}));
    EXPECT_TRUE(matrix_near(state.mean(), mean, 1e-12));  // the landmark may have come into the submap
    EXPECT_TRUE(matrix_near(state.covariance(), covariance, 1e-12));
  }
}

}  // namespace
}  // namespace waymark::ekf
