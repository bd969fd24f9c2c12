#include "waymark/ekf/locate.hpp"

#include <cmath>
#include <vector>

#include <Eigen/LU>

#include "waymark/core/chi2.hpp"
#include "waymark/core/cholesky.hpp"

namespace waymark::ekf {
namespace {

constexpr int kMostSteps = 40;
/// What a step may still gain in cost when it is the last one.
constexpr double kConverged = 1e-6;
constexpr double kPlausible = 0.999;
/// Minima nearer to each other than this, squared and in standard deviations, are one.
constexpr double kSame = 9.0;
const double kDominates = 2.0 * std::log(1e5);

/// The cost at a position and its quadratic model: cost(p + d) = cost - 2 g^T d + d^T A d.
struct Model {
  Eigen::Index views = 0;
  double nis = 0.0;
  double cost = 0.0;
  Eigen::Vector2d g = Eigen::Vector2d::Zero();
  Eigen::Matrix2d A = Eigen::Matrix2d::Zero();
};

std::optional<Model> model_at(const Eigen::Vector2d& p_world, const LinearizeViews& linearize) {
  const auto views = linearize(p_world);
  if (!views) return std::nullopt;
  const Cholesky S(views->S);
  if (!S.is_positive_definite() || !views->nu.allFinite() || !views->H.allFinite()) return std::nullopt;
  const Eigen::VectorXd nu = S.whiten(views->nu);
  const Eigen::Matrix<double, Eigen::Dynamic, 2> H = S.whiten(Eigen::MatrixXd(views->H));
  return Model{std::ssize(views->nu), nu.squaredNorm(), nu.squaredNorm() + S.log_determinant(),
               H.transpose() * nu, H.transpose() * H};
}

}  // namespace

std::optional<Located> descend(const Eigen::Vector2d& start, const LinearizeViews& views) {
  Eigen::Vector2d p_world = start;
  auto model = model_at(p_world, views);
  double damping = 1e-3;
  for (int step = 0; model && step < kMostSteps; ++step) {
    const Eigen::Matrix2d damped = model->A + damping * model->A.trace() * Eigen::Matrix2d::Identity();
    const Eigen::Vector2d d = damped.inverse() * model->g;
    if (!(model->g.dot(d) > kConverged)) break;
    const auto next = model_at(p_world + d, views);
    const bool better = next && next->cost < model->cost;
    damping = better ? 0.1 * damping : 10.0 * damping;
    if (better) {
      p_world += d;
      model = next;
    }
  }
  if (!model || !(model->A.determinant() > 1e-12 * model->A.trace() * model->A.trace())) return std::nullopt;
  return Located{p_world, model->A.inverse(), model->nis, model->cost, static_cast<int>(model->views) - 2};
}

std::optional<Located> locate(std::span<const Eigen::Vector2d> starts, const LinearizeViews& views) {
  std::vector<Located> found;
  const Located* best = nullptr;
  found.reserve(starts.size());
  for (const Eigen::Vector2d& start : starts) {
    const auto minimum = descend(start, views);
    if (!minimum) continue;
    found.push_back(*minimum);
    if (best == nullptr || minimum->cost < best->cost) best = &found.back();
  }
  if (best == nullptr || best->dof < 1 || best->nis > chi2_quantile(kPlausible, best->dof))
    return std::nullopt;
  const Eigen::Matrix2d information = best->covariance.inverse();
  for (const Located& other : found) {
    const Eigen::Vector2d apart = other.p_world - best->p_world;
    if (other.cost < best->cost + kDominates && apart.dot(information * apart) > kSame) return std::nullopt;
  }
  return *best;
}

}  // namespace waymark::ekf
