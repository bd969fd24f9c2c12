#include "waymark/ekf/map_management.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

namespace waymark::ekf {
namespace {

/// Weight of the newest observation: the average spans about the last five.
constexpr double kNewest = 0.2;

}  // namespace

// By the determinant lemma |P - C S^-1 C^T| / |P| = |S - C^T P^-1 C| / |S|: what is left of S when the pose
// is known.
double information_gain(const PoseObservation& observation) {
  const Eigen::Matrix3d P = observation.P_pose + 1e-12 * Eigen::Matrix3d::Identity();
  const Eigen::Matrix2d given_pose =
      observation.S - observation.C_pose.transpose() * P.inverse() * observation.C_pose;
  const double ratio = observation.S.determinant() / given_pose.determinant();
  return ratio > 1.0 && std::isfinite(ratio) ? 0.5 * std::log(ratio) : 0.0;
}

MapManagement::MapManagement(int capacity) { records_.reserve(static_cast<std::size_t>(capacity)); }

void MapManagement::added(bool pinned) { records_.push_back({.scan = scan_, .pinned = pinned}); }

void MapManagement::matched(int landmark, const PoseObservation& observation) {
  Record& record = records_[static_cast<std::size_t>(landmark)];
  ++record.observations;
  ++record.matches;
  record.scan = scan_;
  const double gain = information_gain(observation);
  record.gain += (record.matches == 1 ? 1.0 : kNewest) * (gain - record.gain);
}

void MapManagement::missed(int landmark) { ++records_[static_cast<std::size_t>(landmark)].observations; }

void MapManagement::removed(int landmark) {
  records_[static_cast<std::size_t>(landmark)] = records_.back();
  records_.pop_back();
}

bool MapManagement::keeps_failing(int landmark) const {
  constexpr int kMinAttempts = 10;
  const Record& record = this->record(landmark);
  return record.observations >= kMinAttempts && 2 * record.matches < record.observations;
}

double MapManagement::usefulness(const Record& record) {
  if (record.observations == 0) return record.gain;
  return record.gain * record.matches / record.observations;
}

std::optional<int> MapManagement::least_useful() const {
  std::optional<int> worst;
  for (std::size_t i = 0; i < records_.size(); ++i) {
    const auto index = static_cast<int>(i);
    if (records_[i].pinned || is_in_scan(index)) continue;
    if (!worst || usefulness(index) < usefulness(*worst)) worst = index;
  }
  return worst;
}

}  // namespace waymark::ekf
