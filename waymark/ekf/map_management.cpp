#include "waymark/ekf/map_management.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

namespace waymark::ekf {
namespace {

/// Weight of the newest sighting: the average spans about the last five.
constexpr double kNewest = 0.2;

}  // namespace

// By the determinant lemma |P - C S^-1 C^T| / |P| = |S - C^T P^-1 C| / |S|: what is left of S when the pose
// is known.
double information_gain(const PoseSighting& sighting) {
  const Eigen::Matrix3d P = sighting.P_pose + 1e-12 * Eigen::Matrix3d::Identity();
  const Eigen::Matrix2d given_pose = sighting.S - sighting.C_pose.transpose() * P.inverse() * sighting.C_pose;
  const double ratio = sighting.S.determinant() / given_pose.determinant();
  return ratio > 1.0 && std::isfinite(ratio) ? 0.5 * std::log(ratio) : 0.0;
}

double article_score(const PoseSighting& sighting) {
  const Eigen::Matrix<double, 3, 2> K_pose = sighting.C_pose * sighting.S.inverse();  // Vincke (12)
  return 3.0 - (K_pose * sighting.H_pose).trace();
}

MapManagement::MapManagement(Eviction eviction, int capacity) : eviction_(eviction) {
  records_.reserve(static_cast<std::size_t>(capacity));
}

void MapManagement::added(bool pinned) { records_.push_back({.scan = scan_, .pinned = pinned}); }

void MapManagement::matched(int landmark, const PoseSighting& sighting) {
  Record& record = records_[static_cast<std::size_t>(landmark)];
  ++record.sightings;
  ++record.matches;
  record.scan = scan_;
  if (eviction_ == Eviction::kArticle) record.gain = 3.0 - article_score(sighting);
  if (eviction_ != Eviction::kInformation) return;
  const double gain = information_gain(sighting);
  record.gain += (record.matches == 1 ? 1.0 : kNewest) * (gain - record.gain);
}

void MapManagement::missed(int landmark) { ++records_[static_cast<std::size_t>(landmark)].sightings; }

void MapManagement::removed(int landmark) {
  records_[static_cast<std::size_t>(landmark)] = records_.back();
  records_.pop_back();
}

bool MapManagement::keeps_failing(int landmark) const {
  constexpr int kLeastAttempts = 10;
  const Record& record = this->record(landmark);
  return record.sightings >= kLeastAttempts && 2 * record.matches < record.sightings;
}

double MapManagement::usefulness(const Record& record) const {
  if (eviction_ == Eviction::kArticle || record.sightings == 0) return record.gain;
  return record.gain * record.matches / record.sightings;
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
