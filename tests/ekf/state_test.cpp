#include "waymark/ekf/state.hpp"

#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <gtest/gtest.h>

#include "support/matrix_near.hpp"
#include "support/poses.hpp"
#include "waymark/core/gaussian.hpp"
#include "waymark/core/random.hpp"

#include "dense_filter.hpp"
#include "random_observations.hpp"

namespace waymark::ekf {
namespace {

using test::DenseFilter;
using test::matrix_near;
using test::random_errors;
using test::random_motion;
using test::random_observation;
using test::small_map;

struct StateCase {
  int dimension;
  Consistency consistency;
  int bias_pairs = 0;
};

/// The fast state and the plain one in a random world of their own, given the same random operations.
class Twins {
 public:
  Twins(const StateCase& kind, int capacity, std::uint64_t seed)
      : kind_(kind),
        state_(kind.dimension, capacity, kind.consistency, 1, kind.bias_pairs),
        dense_(kind.dimension, kind.consistency, kind.bias_pairs),
        random_(seed, StreamPurpose::kWorld) {
    predict();  // from here on the covariance is positive definite
    for (int pair = 0; pair < kind.bias_pairs; ++pair) propagate(pair, 0.0);
  }

  void step() {
    const double what = random_.uniform();
    if (kind_.bias_pairs > 0 && random_.uniform() < 0.3)
      propagate(static_cast<int>(random_.uniform() * kind_.bias_pairs), random_.uniform());
    if (what < 0.45)
      predict();
    else if (what < 0.6 && state_.landmarks() < state_.capacity())
      append();
    else if (what < 0.65 && state_.landmarks() > 0)
      remove();
    else if (what < 0.68 && anchors())
      make_absolute();
    else if (state_.landmarks() > 0)
      update();
  }

  /// Equal to within `tolerance` of the largest entry, symmetric and positive definite.
  void expect_equal(double tolerance) const {
    ASSERT_EQ(state_.mean().size(), dense_.mean().size());
    Eigen::VectorXd error = state_.mean() - dense_.mean();
    error[2] = wrap_angle(error[2]);
    EXPECT_LT(error.cwiseAbs().maxCoeff(), tolerance);
    const Eigen::MatrixXd expected = dense_.covariance();
    const Eigen::MatrixXd P = state_.covariance();
    EXPECT_TRUE(matrix_near(P, expected, tolerance * std::max(1.0, expected.cwiseAbs().maxCoeff())));
    for (int pair = 0; pair < kind_.bias_pairs; ++pair)
      EXPECT_TRUE(matrix_near(state_.biases(pair), dense_.biases(pair), tolerance));
    EXPECT_EQ(P, P.transpose());
    EXPECT_EQ(P.llt().info(), Eigen::Success);
  }

 private:
  [[nodiscard]] int any_landmark() { return static_cast<int>(random_.uniform() * state_.landmarks()); }

  void propagate(int pair, double rho) {
    state_.propagate_bias(pair, rho);
    dense_.propagate_bias(pair, rho);
  }

  void predict() {
    const Motion motion = random_motion(random_);
    state_.predict(motion);
    dense_.predict(motion);
  }

  /// Only three values can be a pose, or relative to one.
  void append() {
    const double what = kind_.dimension == 3 ? random_.uniform() : 1.0;
    if (what < 0.2)
      add_pose();
    else if (what < 0.5)
      add_relative();
    else
      add();
  }

  [[nodiscard]] bool anchors() const { return kind_.dimension == 3 && state_.landmarks() > 1; }
  [[nodiscard]] int another_than(int landmark) {
    return (landmark + 1 + static_cast<int>(random_.uniform() * (state_.landmarks() - 1))) %
           state_.landmarks();
  }

  void add_pose() {
    state_.add_pose();
    dense_.add_pose();
    predict();  // a pose and its copy together are singular
  }

  void add_relative() {
    const Eigen::Vector3d values(random_.normal(), random_.normal(), random_.normal());
    const Eigen::Matrix3d noise = test::random_covariance<3>(random_, 0.01);
    state_.add_relative(values, noise);
    dense_.add_relative(values, noise);
  }

  void make_absolute() {
    const int landmark = any_landmark();
    const int anchor = another_than(landmark);
    const Eigen::Vector3d position(random_.uniform(-9.0, 9.0), random_.uniform(-9.0, 9.0), 0.5);
    Eigen::Matrix3d G_anchor, G_landmark = Eigen::Matrix3d::Identity();
    for (auto& entry : G_anchor.reshaped()) entry = 0.3 * random_.normal();
    for (auto& entry : G_landmark.reshaped()) entry += 0.1 * random_.normal();
    state_.make_absolute(landmark, anchor, position, G_anchor, G_landmark);
    dense_.make_absolute(landmark, anchor, position, G_anchor, G_landmark);
  }

  void add() {
    const Eigen::Vector3d position(random_.uniform(-9.0, 9.0), random_.uniform(-9.0, 9.0),
                                   random_.uniform(-1.0, 1.0));
    Eigen::Matrix3d G = Eigen::Matrix3d::Identity();
    for (auto& entry : G.reshaped()) entry += 0.3 * random_.normal();
    const Eigen::Matrix3d noise = test::random_covariance<3>(random_, 0.01);
    const BiasTerms errors = random_errors(random_, kind_.bias_pairs);
    state_.add(position, G, noise, errors);
    dense_.add(position, G, noise, errors);
  }

  void remove() {
    const int index = any_landmark();
    state_.remove(index);
    dense_.remove(index);
  }

  [[nodiscard]] LinearizedObservation any_observation() {
    LinearizedObservation s = random_observation(random_, any_landmark(), kind_.dimension, kind_.bias_pairs);
    if (anchors() && random_.uniform() < 0.4) s.anchor = another_than(s.landmark);
    return s;
  }

  void update() {
    std::vector<LinearizedObservation> linearizations;
    for (int i = 0; i < 1 + static_cast<int>(random_.uniform() * 4); ++i)
      linearizations.push_back(any_observation());
    expect_equal_covariance_of(linearizations);
    ASSERT_TRUE(state_.propose(linearizations));
    const Pose2 proposed = state_.proposal().pose();
    const Eigen::Vector3d proposed_landmark = state_.proposal().landmark(linearizations[0].landmark);
    state_.accept();
    EXPECT_EQ(proposed, state_.pose().T_world_robot);
    EXPECT_TRUE(matrix_near(proposed_landmark, state_.landmark(linearizations[0].landmark), 1e-14));
    dense_.update(linearizations);
  }

  void expect_equal_covariance_of(std::span<const LinearizedObservation> linearizations) {
    const Eigen::MatrixXd S = dense_.innovation_covariance(linearizations);
    const Eigen::MatrixXd lower =
        state_.joint_innovation_covariance(linearizations).triangularView<Eigen::Lower>();
    EXPECT_TRUE(matrix_near(lower, Eigen::MatrixXd(S.triangularView<Eigen::Lower>()),
                            1e-8 * std::max(1.0, S.cwiseAbs().maxCoeff())));
    const LinearizedObservation& first = linearizations[0];
    EXPECT_TRUE(matrix_near(state_.innovation_covariance(first).topLeftCorner(first.rows, first.rows),
                            S.topLeftCorner(first.rows, first.rows), 1e-8 * std::max(1.0, S.maxCoeff())));
  }

  StateCase kind_;
  State state_;
  DenseFilter dense_;
  RandomStream random_;
};

class StateAgainstDenseFilter : public testing::TestWithParam<StateCase> {
 protected:
  /// `operations` random ones in one world, compared now and then.
  static void compare(int capacity, std::uint64_t seed, int operations) {
    Twins twins(GetParam(), capacity, seed);
    for (int i = 1; i <= operations; ++i) {
      twins.step();
      if (i % 100 == 0) twins.expect_equal(kTolerance);
      if (HasFailure()) return;
    }
  }

  // The long-double filter is exact for this purpose; what is left is the rounding of double arithmetic that
  // piles up over the operations. Its covariance stays below about 10 in every entry.
  static constexpr double kTolerance = 1e-8;
};

TEST_P(StateAgainstDenseFilter, StaysEqualInAMapOfManyLandmarks) { compare(20, 7, 600); }

// With nine kinds of filter a million operations in all.
TEST_P(StateAgainstDenseFilter, StaysEqualInManyRandomWorlds) {
  constexpr int kWorlds = 112;
  constexpr int kOperations = 1000;
  for (int world = 0; world < kWorlds && !HasFailure(); ++world)
    compare(1 + world % 5, 100 + static_cast<std::uint64_t>(world), kOperations);
}

INSTANTIATE_TEST_SUITE_P(
    AllModes, StateAgainstDenseFilter,
    testing::Values(StateCase{2, Consistency::kStandard}, StateCase{2, Consistency::kInvariant},
                    StateCase{2, Consistency::kFej}, StateCase{3, Consistency::kStandard},
                    StateCase{3, Consistency::kInvariant, 1}, StateCase{3, Consistency::kFej},
                    StateCase{2, Consistency::kStandard, 3}, StateCase{2, Consistency::kInvariant, 3},
                    StateCase{3, Consistency::kFej, 2}));

TEST(State, InflatesTheCovarianceOfALandmark) {
  RandomStream random(6, StreamPurpose::kWorld);
  const auto made = small_map(random, 5);
  Eigen::MatrixXd expected = made->covariance();
  const Eigen::Matrix3d more = test::random_covariance<3>(random, 0.1);
  made->inflate(2, more);
  expected.block<2, 2>(7, 7) += more.topLeftCorner<2, 2>();
  EXPECT_TRUE(matrix_near(made->covariance(), expected, 1e-15));
}

TEST(State, RefusesAnInnovationCovarianceThatIsNotPositive) {
  RandomStream random(5, StreamPurpose::kWorld);
  const auto made = small_map(random, 3);
  State& state = *made;
  const Eigen::VectorXd mean = state.mean();
  const Eigen::MatrixXd covariance = state.covariance();
  for (const double r : {-100.0, std::nan("")}) {
    LinearizedObservation s = random_observation(random, 1, 2);
    s.R = r * Eigen::Matrix2d::Identity();
    EXPECT_FALSE(state.update({&s, 1}));
    EXPECT_EQ(state.mean(), mean);
    EXPECT_EQ(state.covariance(), covariance);
  }
}

TEST(State, TwoThreadsGiveTheSameBits) {
  std::vector<Eigen::MatrixXd> results;
  for (const int threads : {1, 2}) {
    RandomStream random(6, StreamPurpose::kWorld);
    const auto made = small_map(random, 500, threads);
    State& state = *made;  // n = 1003: large enough to be split
    for (int i = 0; i < 3; ++i) {
      const std::vector<LinearizedObservation> linearizations{random_observation(random, 5, 2),
                                                              random_observation(random, 400, 2)};
      ASSERT_TRUE(state.update(linearizations));
    }
    results.push_back(state.covariance());
  }
  EXPECT_TRUE(results[0] == results[1]);
}

/// P after an update with the gain K (Joseph form), of which the rows of the landmarks are zero: Schmidt's
/// filter as a textbook has it.
TEST(State, HoldingLandmarksIsTheConsiderFilter) {
  RandomStream random(3, StreamPurpose::kWorld);
  constexpr int kLandmarks = 6;
  constexpr int kSize = 3 + 2 * kLandmarks;
  Eigen::MatrixXd A = Eigen::MatrixXd::NullaryExpr(kSize, kSize, [&] { return 0.1 * random.normal(); });
  const Eigen::MatrixXd P_start = A * A.transpose();
  Eigen::VectorXd x = Eigen::VectorXd::NullaryExpr(kSize, [&] { return random.normal(); });
  State state(2, kLandmarks, Consistency::kStandard, 1, 2);
  state.load(x, P_start);
  state.hold_landmarks();
  for (int step = 0; step < 20; ++step) {
    state.predict(random_motion(random));
    const Eigen::MatrixXd P = state.covariance();
    x = state.mean();
    LinearizedObservation linearization = random_observation(random, step % kLandmarks, 2);
    linearization.rows = 2;
    Eigen::MatrixXd H = Eigen::MatrixXd::Zero(2, kSize);
    H.leftCols<3>() = linearization.H_pose;
    H.middleCols<2>(3 + 2 * linearization.landmark) = linearization.H_landmark.leftCols<2>();
    Eigen::MatrixXd K = P * H.transpose() * (H * P * H.transpose() + linearization.R).inverse();
    K.bottomRows(kSize - 3).setZero();
    const Eigen::MatrixXd I_KH = Eigen::MatrixXd::Identity(kSize, kSize) - K * H;
    ASSERT_TRUE(state.update({&linearization, 1}));
    Eigen::VectorXd expected = x + K * linearization.nu;
    expected[2] = wrap_angle(expected[2]);
    EXPECT_TRUE(matrix_near(state.mean(), expected, 1e-12));
    const Eigen::MatrixXd P_after = I_KH * P * I_KH.transpose() + K * linearization.R * K.transpose();
    EXPECT_TRUE(matrix_near(state.covariance(), P_after, 1e-12));
  }
  EXPECT_EQ(state.covariance().bottomRightCorner(kSize - 3, kSize - 3),
            P_start.bottomRightCorner(kSize - 3, kSize - 3).selfadjointView<Eigen::Upper>().toDenseMatrix());
}

TEST(State, ARobotThatIsPutSomewhereElseIsIndependentOfTheMap) {
  State state(2, 1, Consistency::kStandard);
  state.load(Eigen::VectorXd::LinSpaced(5, 0.0, 1.0),
             Eigen::MatrixXd::Identity(5, 5) + Eigen::MatrixXd::Constant(5, 5, 0.5));
  state.place_robot({{4.0, 5.0, 0.5}, 2.0 * Eigen::Matrix3d::Identity()});
  Eigen::MatrixXd expected = 2.0 * Eigen::MatrixXd::Identity(5, 5);
  expected.bottomRightCorner<2, 2>() << 1.5, 0.5, 0.5, 1.5;
  EXPECT_EQ(state.covariance(), expected);
  EXPECT_EQ(state.pose().T_world_robot, (Pose2{4.0, 5.0, 0.5}));
}

}  // namespace
}  // namespace waymark::ekf
