#include "waymark/association/fault_isolation.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

#include "waymark/core/gaussian.hpp"

namespace waymark {
namespace {

// docs/fault-isolation.md, "How many observations".
constexpr int kOutweighOne = 2;          // that agree with each other, against one
constexpr int kOutweighMany = 3;         // against those of a landmark that was observed more than once
constexpr int kOutweighOneUnplaced = 3;  // of ranges or bearings alone, of which any two agree
constexpr int kOutweighManyUnplaced = 6;
constexpr int kLong = 5;            // after so many that were gated
constexpr double kLateGate = 0.99;  // one is accepted only if it fits as most do
constexpr int kSupport = 3;         // accepted observations of other landmarks meanwhile
constexpr int kSupporters = 2;      // other landmarks that they are of
constexpr int kLostObservations = 5;
constexpr int kLostLandmarks = 2;
constexpr int kCarriedOneIn = 10;      // landmarks at most, or one in all
constexpr int kSureObservations = 10;  // of two landmarks
constexpr double kSlip_m = 0.18;       // sigma of what kSlipInflations add

/// The product of the standard deviations of where a landmark was expected across and along the view, from
/// the innovation covariance of range (m) and bearing (rad); 0 where it has no place.
double expected_m2(const Innovation& innovation, const ObservedLandmark* seen) {
  if (seen == nullptr || innovation.dof != 2) return 0.0;
  const double log_determinant = -2.0 * innovation.log_density - innovation.nis - 2.0 * kLogTwoPi;
  return std::exp(0.5 * log_determinant) * seen->p_robot.norm();
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

FaultIsolation::FaultIsolation(const LandmarkSensor& sensor)
    : independent_m_(sensor.errors.bias_distance_m), late_gate_({kLateGate}), contradictions_(sensor) {}

void FaultIsolation::review(std::span<const Observation> observations, std::span<Innovation> innovations,
                            const LandmarkTable& table) {
  wrong_.assign(innovations.size(), 0);
  for (Innovation& innovation : innovations)
    if (is_accepted_too_late(innovation)) innovation.outcome = Outcome::kGated;
  for (std::size_t i = 0; i < innovations.size(); ++i) {
    if (!observations[i].id || innovations[i].outcome != Outcome::kMatched) continue;
    const auto landmark = table.find(innovations[i].landmark);
    contradictions_.support(innovations[i].landmark, landmark && table.is_connected(*landmark));
  }
  bool slipped = false;
  for (std::size_t i = 0; i < innovations.size(); ++i) {
    if (!observations[i].id || innovations[i].outcome != Outcome::kGated) continue;
    const auto landmark = table.find(innovations[i].landmark);
    if (!landmark) continue;
    Contradiction& contradiction = contradictions_.contradict(innovations[i].landmark, observations[i]);
    contradiction.once = table[*landmark].observations == 1;
    slipped |= may_be_a_slip(contradiction, innovations[i]);
    wrong_[i] = is_outweighed(contradiction) &&
                (contradiction.once || may_be_carried(contradiction.id, table.size()));
    if (wrong_[i]) blame(contradiction);
  }
  lost_ = judge_robot(innovations);
  slipped_ = slipped && !lost_ && is_mostly_gated(innovations);
}

/// The gate widens as the robot drives on without a fix, until it lets pass what it refused all the time.
bool FaultIsolation::is_accepted_too_late(const Innovation& innovation) const {
  if (innovation.outcome != Outcome::kMatched) return false;
  const Contradiction* const contradiction = contradictions_.find(innovation.landmark);
  return contradiction != nullptr && contradiction->observations >= kLong &&
         innovation.nis > late_gate_.threshold(innovation.dof);
}

/// How many other landmarks that the map is sure of contradict the pose, since or while this one does.
int FaultIsolation::other_landmarks_against(const Contradiction& contradiction) const {
  return static_cast<int>(std::ranges::count_if(contradictions_.all(), [&](const Contradiction& each) {
    return each.id != contradiction.id && !each.once && each.observations >= kOutweighOne;
  }));
}

bool FaultIsolation::is_outweighed(const Contradiction& contradiction) const {
  const int one = contradiction.placed ? kOutweighOne : kOutweighOneUnplaced;
  const int many = contradiction.placed ? kOutweighMany : kOutweighManyUnplaced;
  if (contradiction.once) return contradiction.observations >= one;
  const int supporters = contradictions_.supporters_since(contradiction);
  const bool independent = contradictions_.travelled_since_m(contradiction) > independent_m_;
  return independent && contradiction.observations >= many &&
         contradictions_.support_since(contradiction) >= kSupport && supporters >= kSupporters &&
         supporters > other_landmarks_against(contradiction);
}

/// Where many landmarks seem to have been moved it is not the landmarks.
bool FaultIsolation::may_be_carried(LandmarkId id, int landmarks) const {
  const bool again = std::ranges::find(carried_, id) != carried_.end();
  return again || std::ssize(carried_) < std::max(1, landmarks / kCarriedOneIn);
}

/// The landmark begins anew; one that was found elsewhere before is where it is only now and then.
void FaultIsolation::blame(const Contradiction& contradiction) {
  const LandmarkId id = contradiction.id;
  if (contradiction.once) {
    ++false_firsts_;
  } else if (std::ranges::find(carried_, id) == carried_.end()) {
    carried_.push_back(id);
  } else if (!is_distrusted(id)) {
    distrusted_.push_back(id);
  }
  contradictions_.forget(id);
}

/// No more landmarks have supported the pose since it began than others contradict it.
bool FaultIsolation::speaks_of_the_robot(const Contradiction& contradiction) const {
  return !contradiction.once && contradiction.observations >= kOutweighOne &&
         contradictions_.supporters_since(contradiction) <= other_landmarks_against(contradiction);
}

bool FaultIsolation::judge_robot(std::span<const Innovation> innovations) {
  int landmarks = 0;
  contradicting_ = 0;
  for (const Contradiction& each : contradictions_.all()) {
    if (!speaks_of_the_robot(each)) continue;
    ++landmarks;
    contradicting_ += each.observations;
  }
  const bool lost = landmarks >= kLostLandmarks && contradicting_ >= kLostObservations;
  if (!lost) asked_at_ = 0;
  return lost && (lost_ || is_mostly_gated(innovations));
}

/// One landmark alone, which nothing supports, has just been gated often enough. That the robot slipped a
/// little is likelier than that someone moved the landmark a little; but where it was expected anywhere
/// within more than a slip, a slip explains nothing.
bool FaultIsolation::may_be_a_slip(const Contradiction& contradiction, const Innovation& innovation) const {
  return !contradiction.once && contradiction.in_a_row == kLostObservations &&
         contradictions_.supporters_since(contradiction) == 0 &&
         expected_m2(innovation, contradictions_.seen(contradiction)) < kSlip_m * kSlip_m;
}

bool FaultIsolation::is_distrusted(LandmarkId id) const {
  return !distrusted_.empty() && std::ranges::find(distrusted_, id) != distrusted_.end();
}

bool FaultIsolation::wants_relocation() {
  if (slipped_) return true;
  if (!lost_ || contradicting_ < asked_at_ + std::max(kLostObservations, asked_at_ / 4)) return false;
  asked_at_ = contradicting_;
  return true;
}

std::optional<Motion> FaultIsolation::find_motion(const MapState& map, const Pose2& T_world_robot) const {
  std::vector<ObservedLandmark> seen;
  bool supported = false;
  for (const Contradiction& each : contradictions_.all()) {
    if (!speaks_of_the_robot(each)) continue;
    supported |= contradictions_.supporters_since(each) > 0;
    if (const ObservedLandmark* const at = contradictions_.seen(each)) seen.push_back(*at);
  }
  const PoseCandidates found = find_pose(seen, map);
  const auto enough = std::max<std::ptrdiff_t>(kLostLandmarks, (2 * std::ssize(seen) + 2) / 3);
  if (found.best.agreeing < enough) return std::nullopt;
  // Two are as far apart as in the map by chance now and then.
  if (found.best.agreeing == kLostLandmarks && (supported || contradicting_ < kSureObservations))
    return std::nullopt;
  // Three sigmas: the next observations are used again, and those of one place have errors in common.
  return Motion{T_world_robot.inverse() * found.best.T_world_robot,
                9.0 * increment_covariance(found.best, seen, map, T_world_robot), 0.0};
}

FilterHealth FaultIsolation::health() const {
  return {.false_firsts = false_firsts_,
          .carried = static_cast<int>(carried_.size()),
          .distrusted = static_cast<int>(distrusted_.size()),
          .slips = slips_,
          .recoveries = recoveries_,
          .lost = lost_};
}

void FaultIsolation::forget() {
  lost_ = slipped_ = false;
  asked_at_ = 0;
  contradictions_.clear();
}

}  // namespace waymark
