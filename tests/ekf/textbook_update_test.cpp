#include "waymark/ekf/textbook_update.hpp"

#include <array>
#include <cmath>
#include <vector>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "support/allocation_counter.hpp"
#include "support/matrix_near.hpp"
#include "support/poses.hpp"
#include "waymark/core/random.hpp"
#include "waymark/ekf/state.hpp"

namespace waymark::ekf {
namespace {

using test::matrix_near;

DenseMatrix& set(DenseMatrix& to, const Eigen::MatrixXd& from) {
  for (Eigen::Index i = 0; i < from.rows(); ++i)
    for (Eigen::Index j = 0; j < from.cols(); ++j)
      to(static_cast<std::size_t>(i), static_cast<std::size_t>(j)) = from(i, j);
  return to;
}

Eigen::MatrixXd get(const DenseMatrix& from) {
  Eigen::MatrixXd to(from.rows(), from.columns());
  for (Eigen::Index i = 0; i < to.rows(); ++i)
    for (Eigen::Index j = 0; j < to.cols(); ++j)
      to(i, j) = from(static_cast<std::size_t>(i), static_cast<std::size_t>(j));
  return to;
}

Eigen::MatrixXd random_matrix(RandomStream& random, Eigen::Index rows, Eigen::Index columns) {
  Eigen::MatrixXd made(rows, columns);
  for (double& entry : made.reshaped()) entry = random.normal();
  return made;
}

struct Problem {
  Eigen::MatrixXd H, P, R;
  Eigen::VectorXd nu;
};
Problem random_problem(RandomStream& random, Eigen::Index D, Eigen::Index n) {
  const Eigen::MatrixXd root = random_matrix(random, n, n), noise_root = random_matrix(random, D, D);
  return {random_matrix(random, D, n), root * root.transpose(),
          noise_root * noise_root.transpose() + Eigen::MatrixXd::Identity(D, D), random_matrix(random, D, 1)};
}
void load(TextbookUpdate& update, const Problem& problem) {
  update.begin(static_cast<std::size_t>(problem.H.rows()), static_cast<std::size_t>(problem.H.cols()));
  set(update.H, problem.H);
  set(update.P, problem.P);
  set(update.R, problem.R);
  set(update.nu, problem.nu);
}

TEST(TextbookUpdate, IsWhatIsWritten) {
  RandomStream random(1, StreamPurpose::kWorld);
  TextbookUpdate update(8, 20);
  for (const auto& [D, n] : {std::array{8, 20}, {1, 3}, {5, 13}, {8, 20}}) {
    const auto problem = random_problem(random, D, n);
    const auto& [H, P, R, nu] = problem;
    load(update, problem);
    ASSERT_TRUE(update.solve());
    update.correct();
    const Eigen::MatrixXd K = P * H.transpose() * (H * P * H.transpose() + R).inverse();
    EXPECT_TRUE(matrix_near(get(update.dx), K * nu, 1e-9));
    EXPECT_TRUE(matrix_near(get(update.P), (Eigen::MatrixXd::Identity(n, n) - K * H) * P, 1e-9));
  }
}

TEST(TextbookUpdate, RefusesAnInnovationCovarianceThatIsNotPositive) {
  RandomStream random(2, StreamPurpose::kWorld);
  TextbookUpdate update(4, 9);
  for (const double r : {-1e4, std::nan("")}) {
    Problem problem = random_problem(random, 4, 9);
    problem.R *= r;
    load(update, problem);
    EXPECT_FALSE(update.solve());
  }
}

/// A robot with poses, points and what is relative to poses.
void fill(State& state, RandomStream& random) {
  state.predict({{0.1, 0.0, 0.1}, test::random_covariance<3>(random, 1e-3)});
  state.propagate_bias(0, 0.0);
  for (int i = 0; i < 4; ++i) {
    state.add_pose();
    state.predict({{0.1, 0.0, 0.1}, test::random_covariance<3>(random, 1e-3)});
    state.add_relative({0.1, 0.2, 0.3}, test::random_covariance<3>(random, 1e-2));
    state.add({5.0, random.normal(), 1.0}, Eigen::Matrix3d::Identity(),
              test::random_covariance<3>(random, 1e-2));
  }
}

std::vector<LinearizedObservation> linearizations(RandomStream& random) {
  std::vector<LinearizedObservation> made(5);
  for (int i = 0; i < 5; ++i) {
    LinearizedObservation& s = made[static_cast<std::size_t>(i)];
    s.landmark = 2 * i + 1;
    s.anchor = i % 2 == 0 ? 2 * i : -1;
    s.rows = i == 3 ? 1 : 2;
    s.nu = 0.05 * random_matrix(random, 2, 1);
    s.H_pose = random_matrix(random, 2, 3);
    s.H_landmark = random_matrix(random, 2, 3);
    s.H_anchor = random_matrix(random, 2, 3);
    s.R = test::random_covariance<2>(random, 0.05);
    if (i == 2) s.errors[0].pair = 0;
    s.errors[0].J = 0.1 * random_matrix(random, 3, 2);
  }
  return made;
}

TEST(TextbookUpdate, OfAStateIsThatOfTheFastOne) {
  RandomStream random(3, StreamPurpose::kWorld);
  State fast(3, 20, Consistency::kStandard, 1, 1);
  State slow(3, 20, Consistency::kStandard, 1, 1);
  slow.use_textbook_update();
  for (State* state : {&fast, &slow}) {
    RandomStream same(4, StreamPurpose::kWorld);
    fill(*state, same);
  }
  for (int i = 0; i < 10; ++i) {
    const auto seen = linearizations(random);
    ASSERT_TRUE(fast.propose(seen));
    ASSERT_TRUE(slow.propose(seen));
    EXPECT_TRUE(matrix_near(slow.proposal().explained(seen[0]), fast.proposal().explained(seen[0]), 1e-10));
    fast.accept();
    slow.accept();
    EXPECT_TRUE(matrix_near(slow.mean(), fast.mean(), 1e-10));
    EXPECT_TRUE(matrix_near(slow.covariance(), fast.covariance(), 1e-10));
    EXPECT_TRUE(matrix_near(slow.biases(0), fast.biases(0), 1e-10));
    for (State* state : {&fast, &slow}) state->predict({{0.1, 0.0, 0.0}, 1e-4 * Eigen::Matrix3d::Identity()});
  }
}

TEST(TextbookUpdate, OfAStateAllocatesNothing) {
  RandomStream random(5, StreamPurpose::kWorld);
  State state(3, 20, Consistency::kStandard, 1, 1);
  state.use_textbook_update();
  fill(state, random);
  const auto seen = linearizations(random);
  const test::AllocationCount count;
  ASSERT_TRUE(state.update(seen));
  EXPECT_EQ(count.allocations(), 0);
}

}  // namespace
}  // namespace waymark::ekf
