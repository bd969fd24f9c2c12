#include "waymark/association/joint_compatibility.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "waymark/core/as_index.hpp"
#include "waymark/core/chi2.hpp"
#include "waymark/core/gaussian.hpp"

namespace waymark {
namespace {

/// A L^-T. Eigen's own solver is made for larger ones.
Eigen::Matrix2d divided_by_transposed(const Eigen::Matrix2d& A, const Eigen::Matrix2d& L) {
  Eigen::Matrix2d X;
  X.col(0) = A.col(0) / L(0, 0);
  X.col(1) = (A.col(1) - X.col(0) * L(1, 0)) / L(1, 1);
  return X;
}

}  // namespace

JointCompatibility::JointCompatibility(double gate_probability, int max_observations, int max_nodes)
    : gates_(as_index(max_observations) + 1),
      max_nodes_(max_nodes),
      steps_(as_index(max_observations)),
      L_(as_index(max_observations * max_observations)) {
  for (int k = 1; k <= max_observations; ++k) gates_[as_index(k)] = chi2_quantile(gate_probability, 2 * k);
  chosen_.reserve(as_index(max_observations));
}

void JointCompatibility::begin(int observations) {
  best_.assign(as_index(observations), kNothing);
  common_.resize(pairs_.size() * pairs_.size());
  is_known_.assign(common_.size(), 0);
}

/// Most pairs are never tried together.
const Eigen::Matrix2d& JointCompatibility::common(std::size_t a, std::size_t b) {
  const std::size_t at = a * pairs_.size() + b;
  if (is_known_[at] == 0) common_[at] = covariance_(context_, static_cast<int>(a), static_cast<int>(b));
  is_known_[at] = 1;
  return common_[at];
}

void JointCompatibility::search() {
  rank_pairs();
  chosen_.clear();
  best_score_ = 0.0;
  nodes_ = 0;
  descend(0, 0.0);
}

/// Levels with their pairs, the surest observation first: it leaves the least open for those after it.
void JointCompatibility::rank_pairs() {
  order_.clear();
  alone_.clear();
  for (int p = 0; p < static_cast<int>(pairs_.size()); ++p) {
    order_.push_back(p);
    alone_.push_back(score_alone(p));
  }
  std::ranges::sort(order_, {}, [this](int p) {
    return std::tuple(pairs_[as_index(p)].observation, -alone_[as_index(p)], p);
  });
  levels_.clear();
  for (std::size_t first = 0, next = 0; first < order_.size(); first = next) {
    while (next < order_.size() &&
           pairs_[as_index(order_[next])].observation == pairs_[as_index(order_[first])].observation)
      ++next;
    make_level(first, next - first);
  }
  std::ranges::sort(levels_, {}, [](const Level& level) { return std::tuple(-level.surest, level.first); });
  if (levels_.size() >= gates_.size()) levels_.resize(gates_.size() - 1);
  for (std::size_t i = levels_.size(); i-- > 1;) levels_[i - 1].bound += levels_[i].bound;
}

void JointCompatibility::make_level(std::size_t first, std::size_t count) {
  const double second = count > 1 ? std::max(0.0, alone_[as_index(order_[first + 1])]) : 0.0;
  Level level{first, count, alone_[as_index(order_[first])] - second, 0.0};
  for (std::size_t i = first; i < first + count; ++i) level.bound = std::max(level.bound, most_of(order_[i]));
  levels_.push_back(level);
}

double JointCompatibility::score_alone(int pair) {
  const JointPair& p = pairs_[as_index(pair)];
  const Eigen::LLT<Eigen::Matrix2d> llt(common(as_index(pair), as_index(pair)) + p.R);
  const double log_det = 2.0 * (std::log(llt.matrixLLT()(0, 0)) + std::log(llt.matrixLLT()(1, 1)));
  const double score = p.bonus - 0.5 * (p.nu.dot(llt.solve(p.nu)) + log_det) - kLogTwoPi;
  return std::isfinite(score) ? score : -HUGE_VAL;
}

/// What a pair brings where its innovation is zero and its noise all that is unknown: S >= R.
double JointCompatibility::most_of(int pair) const {
  const JointPair& p = pairs_[as_index(pair)];
  const double most = p.bonus - 0.5 * std::log(p.R.determinant()) - kLogTwoPi;
  return std::isfinite(most) ? most : HUGE_VAL;
}

// Recursion as deep as there are observations.
void JointCompatibility::descend(std::size_t level, double score) {  // NOLINT(misc-no-recursion)
  if (score > best_score_) keep(score);
  if (level == levels_.size() || score + levels_[level].bound <= best_score_) return;
  const Level& here = levels_[level];
  for (std::size_t i = here.first; i < here.first + here.count; ++i) {
    const int pair = order_[i];
    if (is_taken(pairs_[as_index(pair)].landmark)) continue;
    if (++nodes_ > max_nodes_) return;
    if (!choose(pair)) continue;
    descend(level + 1, steps_[chosen_.size() - 1].score);
    chosen_.pop_back();
  }
  descend(level + 1, score);
}

bool JointCompatibility::is_taken(int landmark) const {
  return std::ranges::any_of(chosen_, [&](int pair) { return pairs_[as_index(pair)].landmark == landmark; });
}

void JointCompatibility::keep(double score) {
  best_score_ = score;
  std::ranges::fill(best_, kNothing);
  for (const int pair : chosen_) best_[as_index(pairs_[as_index(pair)].observation)] = pair;
}

/// Appends a pair's two rows to the Cholesky factor of the hypothesis. False, and nothing changed, where that
/// is not compatible.
bool JointCompatibility::choose(int pair) {
  const std::size_t k = chosen_.size();
  const JointPair& p = pairs_[as_index(pair)];
  Eigen::Matrix2d* const row = &L_[k * steps_.size()];
  Eigen::Matrix2d left = common(as_index(pair), as_index(pair)) + p.R;
  Eigen::Vector2d nu = p.nu;
  for (std::size_t j = 0; j < k; ++j) {
    const std::size_t other = as_index(chosen_[j]);
    Eigen::Matrix2d sum = as_index(pair) > other ? common(as_index(pair), other)
                                                 : Eigen::Matrix2d(common(other, as_index(pair)).transpose());
    for (std::size_t i = 0; i < j; ++i) sum -= row[i] * L_[j * steps_.size() + i].transpose();
    row[j] = divided_by_transposed(sum, steps_[j].L);
    left -= row[j] * row[j].transpose();
    nu -= row[j] * steps_[j].y;
  }
  const Eigen::LLT<Eigen::Matrix2d> llt(left);
  if (llt.info() != Eigen::Success) return false;
  Step& step = steps_[k];
  step.L = llt.matrixL();
  step.y[0] = nu[0] / step.L(0, 0);
  step.y[1] = (nu[1] - step.L(1, 0) * step.y[0]) / step.L(1, 1);
  const Step* const before = k > 0 ? &steps_[k - 1] : nullptr;
  step.d2 = (before != nullptr ? before->d2 : 0.0) + step.y.squaredNorm();
  if (!(step.d2 <= gates_[k + 1])) return false;
  step.score = (before != nullptr ? before->score : 0.0) + p.bonus - 0.5 * step.y.squaredNorm() -
               std::log(step.L(0, 0) * step.L(1, 1)) - kLogTwoPi;
  chosen_.push_back(pair);
  return true;
}

}  // namespace waymark
