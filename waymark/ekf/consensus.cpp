#include "waymark/ekf/consensus.hpp"

#include <algorithm>

#include "waymark/core/chi2.hpp"

namespace waymark::ekf {
namespace {

/// Part of the true observations that agree with a true one: few are lost, and these may still be rescued.
constexpr double kConsensus = 0.99;
/// Standard deviation of an innovation, px, from which on a landmark leads the state far. Three of them to
/// either side span two patches: there is room for a corner beside the true one that looks the same.
constexpr double kFar_px = 6.0;
/// So many must lead the state far together. One is wrong easily, and a second one may agree by chance.
constexpr std::size_t kMinReacquired = 3;
/// Standard deviation of an innovation, px, from which on so many matches alone do not convince. The
/// ellipse then is a large part of the image, in which something that looks right is nearly always found.
constexpr double kWide_px = 15.0;
/// Of wrong agreements of landmarks that come back from as far: so many are expected in one image, or one
/// in a thousand images.
constexpr double kFalseAlarms = 1e-3;

/// Trace of the innovation covariance of the k-th observation.
double width_px2(const JointCovariance& S, std::size_t k) {
  const auto row = static_cast<Eigen::Index>(2 * k);
  return S(row, row) + S(row + 1, row + 1);
}

/// Of those that agree, the one whose place was known best.
std::size_t narrowest(const JointCovariance& S, std::span<const char> agrees) {
  std::size_t best = 0;
  for (std::size_t k = 0; k < agrees.size(); ++k)
    if (agrees[k] != 0 && (agrees[best] == 0 || width_px2(S, k) < width_px2(S, best))) best = k;
  return best;
}

}  // namespace

Consensus::Consensus(std::size_t capacity, double gate, double area_px2)
    : gate_(gate),
      consensus_gate_(chi2_quantile(kConsensus, 2)),
      area_px2_(area_px2),
      all_(capacity),
      together_(capacity) {
  reacquired_.reserve(capacity);
  outcomes_.reserve(capacity);
}

/// One or two matches are no evidence where the search was so wide that something that looks right is easily
/// found.
std::span<const Outcome> Consensus::judge(const JointCovariance& S, std::span<const Eigen::Vector2d> nu) {
  const auto agrees = all_.best(S, nu, gate_, consensus_gate_);
  const auto count = static_cast<std::size_t>(std::ranges::count(agrees, char{1}));
  const std::size_t known = narrowest(S, agrees);
  const bool lost = count < kMinReacquired && width_px2(S, known) > kFar_px * kFar_px;
  const bool convincing = !lost && (count >= kMinReacquired || 2 * count > agrees.size());
  outcomes_.assign(nu.size(), Outcome::kMatched);
  for (std::size_t k = 0; k < nu.size(); ++k)
    if (!convincing || agrees[k] == 0) outcomes_[k] = lost ? Outcome::kUnusable : Outcome::kGated;
  if (convincing) check_reacquired(S, nu, agrees, known);
  return outcomes_;
}

/// A landmark that may still be anywhere when another one is known comes back after long: it leads the state
/// far, and needs others that come back with it. Where they may be very far, so many must agree on where
/// that what looks right in wrong places hardly would.
void Consensus::check_reacquired(const JointCovariance& S, std::span<const Eigen::Vector2d> nu,
                                 std::span<const char> agrees, std::size_t known) {
  reacquired_.clear();
  double widest_px2 = 0.0;
  for (std::size_t k = 0; k < nu.size(); ++k) {
    if (agrees[k] == 0 || k == known) continue;
    const double left_px2 = OnePointRansac::left_of(S, k, known).trace();
    if (left_px2 <= kFar_px * kFar_px) continue;
    reacquired_.push_back(k);
    widest_px2 = std::max(widest_px2, left_px2);
  }
  if (reacquired_.size() >= kMinReacquired &&
      (widest_px2 <= kWide_px * kWide_px || judge_together(S, nu, known)))
    return;
  for (const std::size_t k : reacquired_) outcomes_[k] = Outcome::kUnusable;
}

/// Whether those that come back agree more than by chance; those of them that do not are then gated.
bool Consensus::judge_together(const JointCovariance& S, std::span<const Eigen::Vector2d> nu,
                               std::size_t known) {
  const auto rest = all_.rest(S, nu, known, reacquired_);
  const auto agrees = together_.best(rest.S, rest.nu, gate_, consensus_gate_);
  if (!(together_.false_alarms(rest.S, gate_, consensus_gate_, area_px2_) < kFalseAlarms)) return false;
  for (std::size_t i = 0; i < reacquired_.size(); ++i)
    if (agrees[i] == 0) outcomes_[reacquired_[i]] = Outcome::kGated;
  return true;
}

bool Consensus::rescues(double nis, const Eigen::Matrix2d& S) const {
  return nis <= gate_ && S.trace() <= kFar_px * kFar_px;
}

}  // namespace waymark::ekf
