#include "waymark/ekf/iterated_update.hpp"

namespace waymark::ekf {
namespace {

constexpr double kStudentDof = 4.0;
constexpr int kStudentIterations = 3;

int most(int iterations, Likelihood likelihood, Consistency consistency) {
  if (consistency == Consistency::kFej) return 0;
  return likelihood == Likelihood::kStudent ? std::max(iterations, kStudentIterations) : iterations;
}

}  // namespace

IteratedUpdate::IteratedUpdate(int iterations, Likelihood likelihood, Consistency consistency)
    : most_(most(iterations, likelihood, consistency)), likelihood_(likelihood) {
  there_.reserve(State::kMaxObservations);
  refined_.reserve(State::kMaxObservations);
}

/// By how much a Student-t likelihood widens the noise R of an observation of which this residual is left.
double IteratedUpdate::student_t_weight(const LinearizedObservation& left, const Eigen::Matrix2d& R) const {
  if (likelihood_ == Likelihood::kGaussian) return 1.0;
  return (kStudentDof + left.nu.dot(R.llt().solve(left.nu))) / (kStudentDof + left.rows);
}

}  // namespace waymark::ekf
