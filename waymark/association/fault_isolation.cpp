#include "waymark/association/fault_isolation.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

#include "waymark/core/gaussian.hpp"

namespace waymark {
namespace {

// docs/robust.md, "How many observations".
constexpr int kOutweighOne = 2;          // that agree with each other, against one
constexpr int kOutweighMany = 3;         // against those of a landmark that was observed more than once
constexpr int kOutweighOneUnplaced = 3;  // of ranges or bearings alone, of which any two agree
constexpr int kOutweighManyUnplaced = 6;
constexpr int kSupport = 3;  // accepted observations of other landmarks meanwhile
constexpr int kLostObservations = 5;
constexpr int kLostLandmarks = 2;
// The expectation of a landmark is this many times as unsure as its observation (area of the ellipses): an
// observation that is false by as much passes the gate.
constexpr double kUnsureRatio = 10.0;
constexpr double kLongWait_m = 2.0;
constexpr double kGate1 = 10.83;  // 99.9 % of chi-square with one degree of freedom

/// Whether the innovation covariance S of a range and bearing leaves more room than the observation needs.
bool is_vague(const Innovation& innovation, const ObservedLandmark& seen) {
  const double log_det_S = -2.0 * innovation.log_density - innovation.nis - 2.0 * kLogTwoPi;
  const double det_R = seen.covariance.determinant() / seen.p_robot.squaredNorm();
  return log_det_S > std::log(det_R) + 2.0 * std::log(kUnsureRatio);
}

bool is_mostly_gated(std::span<const Innovation> innovations) {
  const auto count = [&](Outcome outcome) {
    return std::ranges::count(innovations, outcome, &Innovation::outcome);
  };
  return count(Outcome::kGated) > count(Outcome::kMatched);
}

/// Of the increment that takes the robot to where it sees these landmarks: the inverse of the information
/// that their places bring, in the frame before.
Eigen::Matrix3d increment_covariance(const PoseCandidate& fit, std::span<const ObservedLandmark> seen,
                                     const MapState& map, const Pose2& T_world_before) {
  const Pose2 increment = T_world_before.inverse() * fit.T_world_robot;
  const Eigen::Matrix2d R_world = T_world_before.rotation();
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  for (std::size_t k = 0; k < seen.size(); ++k) {
    if (fit.landmarks[k] < 0) continue;
    const Eigen::Index row = 3 + 2 * fit.landmarks[k];
    Eigen::Matrix<double, 2, 3> J;
    J.leftCols<2>() = Eigen::Matrix2d::Identity();
    J.col(2) = perpendicular(increment.rotation() * seen[k].p_robot);
    const Eigen::Matrix2d S = increment.rotation() * seen[k].covariance * increment.rotation().transpose() +
                              R_world.transpose() * map.covariance.block<2, 2>(row, row) * R_world;
    information += J.transpose() * S.inverse() * J;
  }
  return information.inverse();
}

}  // namespace

FaultIsolation::FaultIsolation(const LandmarkSensor& sensor) : doubted_(sensor), waiting_(sensor) {
  contradictions_.reserve(LocalMap::kCapacity);
  waiting_since_m_.reserve(LocalMap::kCapacity);
}

void FaultIsolation::predict(const Motion& motion) {
  doubted_.predict(motion);
  waiting_.predict(motion);
  travelled_m_ += travelled_m(motion);
}

/// Remembers what has to wait. Nothing has while one observation ties the robot to its map.
bool FaultIsolation::wait(std::span<const Observation> observations,
                          std::span<const Innovation> innovations) {
  bool is_tied = false;
  bool any = false;
  for (std::size_t i = 0; i < innovations.size(); ++i) {
    if (innovations[i].outcome != Outcome::kMatched || !observations[i].id) continue;
    const auto seen = waiting_.locate(observations[i]);
    if (!seen || !is_vague(innovations[i], *seen)) {
      is_tied = true;
    } else {
      any = true;
      waiting_.observe(observations[i]);
      if (waiting_since_m_.size() < waiting_.landmarks().size()) waiting_since_m_.push_back(travelled_m_);
    }
  }
  if (!is_tied) return any;
  waiting_.clear();
  waiting_since_m_.clear();
  return false;
}

bool FaultIsolation::is_waiting(const Innovation& innovation) const {
  return innovation.outcome == Outcome::kMatched && waiting_.find(innovation.landmark) != nullptr;
}

bool FaultIsolation::has_waited_long(LandmarkId id) const {
  const auto index = static_cast<std::size_t>(waiting_.find(id) - waiting_.landmarks().data());
  return travelled_m_ - waiting_since_m_[index] > kLongWait_m;
}

bool FaultIsolation::are_as_far_apart(LandmarkId first, LandmarkId second, const Apart& apart) const {
  const ObservedLandmark* const a = waiting_.find(first);
  const ObservedLandmark* const b = waiting_.find(second);
  const Eigen::Vector2d seen = b->p_robot - a->p_robot;
  const auto along = [](const Eigen::Vector2d& line, const Eigen::Matrix2d& P) {
    return line.dot(P * line) / std::max(line.squaredNorm(), 1e-12);
  };
  const double nu = seen.norm() - apart.mean.norm();
  return nu * nu <=
         kGate1 * (along(seen, a->covariance + b->covariance) + along(apart.mean, apart.covariance));
}

void FaultIsolation::review(std::span<const Observation> observations,
                            std::span<const Innovation> innovations, const LandmarkTable& table) {
  wrong_.assign(innovations.size(), 0);
  for (std::size_t i = 0; i < innovations.size(); ++i) {
    if (!observations[i].id || innovations[i].outcome != Outcome::kMatched) continue;
    const auto landmark = table.find(innovations[i].landmark);
    support(innovations[i].landmark, landmark && table.is_connected(*landmark));
  }
  for (std::size_t i = 0; i < innovations.size(); ++i) {
    if (!observations[i].id || innovations[i].outcome != Outcome::kGated) continue;
    const auto landmark = table.find(innovations[i].landmark);
    if (!landmark) continue;
    Contradiction& contradiction = contradict(innovations[i].landmark, observations[i]);
    contradiction.once = table[*landmark].observations == 1;
    wrong_[i] = is_outweighed(contradiction);
    if (wrong_[i]) blame(contradiction);
  }
  lost_ = judge_robot(innovations);
}

/// The landmark begins anew; one that was found wrong before is where it is only now and then.
void FaultIsolation::blame(const Contradiction& contradiction) {
  const LandmarkId id = contradiction.id;
  if (contradiction.once) {
    ++false_firsts_;
  } else if (std::ranges::find(carried_, id) == carried_.end()) {
    carried_.push_back(id);
  } else {
    distrusted_.push_back(id);
  }
  forget(id);
}

void FaultIsolation::forget(LandmarkId id) {
  doubted_.erase(id);
  std::erase_if(contradictions_, [id](const Contradiction& each) { return each.id == id; });
}

/// An accepted observation ends the contradiction of its landmark: the gated ones before were outliers.
void FaultIsolation::support(LandmarkId id, bool is_connected) {
  if (is_connected) ++support_;
  forget(id);
}

FaultIsolation::Contradiction& FaultIsolation::contradict(LandmarkId id, const Observation& observation) {
  const ObservedLandmark* const before = doubted_.find(id);
  const auto seen = doubted_.locate(observation);
  const bool agrees = !seen || !before || LocalMap::agree(*before, *seen);
  doubted_.observe(observation);
  const auto at = std::ranges::find(contradictions_, id, &Contradiction::id);
  const Contradiction first{.id = id, .began_at_support = support_, .placed = seen.has_value()};
  if (at == contradictions_.end()) {
    if (contradictions_.size() == LocalMap::kCapacity) contradictions_.erase(contradictions_.begin());
    return contradictions_.emplace_back(first);
  }
  if (agrees)
    ++at->observations;
  else
    *at = first;
  return *at;
}

bool FaultIsolation::is_outweighed(const Contradiction& contradiction) const {
  const int one = contradiction.placed ? kOutweighOne : kOutweighOneUnplaced;
  const int many = contradiction.placed ? kOutweighMany : kOutweighManyUnplaced;
  if (contradiction.once) return contradiction.observations >= one;
  return contradiction.observations >= many && support_ - contradiction.began_at_support >= kSupport;
}

/// Nothing was accepted since it began.
bool FaultIsolation::speaks_of_the_robot(const Contradiction& contradiction) const {
  return !contradiction.once && contradiction.began_at_support == support_;
}

bool FaultIsolation::judge_robot(std::span<const Innovation> innovations) {
  int landmarks = 0;
  contradicting_ = 0;
  for (const Contradiction& each : contradictions_) {
    if (!speaks_of_the_robot(each)) continue;
    ++landmarks;
    contradicting_ += each.observations;
  }
  const bool lost = landmarks >= kLostLandmarks && contradicting_ >= kLostObservations;
  if (!lost) asked_at_ = 0;
  return lost && (lost_ || is_mostly_gated(innovations));
}

bool FaultIsolation::is_distrusted(LandmarkId id) const {
  return !distrusted_.empty() && std::ranges::find(distrusted_, id) != distrusted_.end();
}

bool FaultIsolation::wants_relocation() {
  if (!lost_ || contradicting_ < 2 * asked_at_) return false;
  asked_at_ = contradicting_;
  return true;
}

std::vector<ObservedLandmark> FaultIsolation::contradicting() const {
  std::vector<ObservedLandmark> seen;
  for (const Contradiction& each : contradictions_)
    if (const ObservedLandmark* at = doubted_.find(each.id); at && speaks_of_the_robot(each))
      seen.push_back(*at);
  return seen;
}

std::optional<Motion> FaultIsolation::find_motion(const MapState& map, const Pose2& T_world_robot) const {
  const std::vector<ObservedLandmark> seen = contradicting();
  const PoseCandidates found = find_pose(seen, map);
  const auto enough = std::max<std::ptrdiff_t>(kLostLandmarks, (2 * std::ssize(seen) + 2) / 3);
  if (found.best.agreeing < enough) return std::nullopt;
  // Three sigmas: the next observations are used again, and those of one place have errors in common.
  return Motion{T_world_robot.inverse() * found.best.T_world_robot,
                9.0 * increment_covariance(found.best, seen, map, T_world_robot), 0.0};
}

FilterHealth FaultIsolation::health() const {
  return {.false_firsts = false_firsts_,
          .carried = static_cast<int>(carried_.size()),
          .distrusted = static_cast<int>(distrusted_.size()),
          .recoveries = relocations_,
          .lost = lost_};
}

void FaultIsolation::relocated() {
  ++relocations_;
  lost_ = false;
  asked_at_ = 0;
  ++support_;
  doubted_.clear();
  waiting_.clear();
  waiting_since_m_.clear();
  contradictions_.clear();
}

}  // namespace waymark
