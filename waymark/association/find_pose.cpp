#include "waymark/association/find_pose.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "waymark/core/as_index.hpp"
#include "waymark/core/gaussian.hpp"

namespace waymark {
namespace {

constexpr double kGate1 = 10.83;  // 99.9 % of chi-square with one degree of freedom
constexpr double kShortest_m = 0.2;
constexpr double kElsewhere_m = 1.0;
constexpr double kElsewhere_rad = 0.3;

Eigen::Vector2d landmark(const MapState& map, int i) { return map.landmarks.segment<2>(2 * i); }
Eigen::Matrix2d common(const MapState& map, int i, int j) {
  return map.covariance.block<2, 2>(3 + 2 * i, 3 + 2 * j);
}
double angle_of(const Eigen::Vector2d& v) { return std::atan2(v.y(), v.x()); }

/// Of a distance between two places with this covariance of their difference, along the line between them.
double variance_along(const Eigen::Vector2d& apart, const Eigen::Matrix2d& covariance) {
  const double length2 = apart.squaredNorm();
  return length2 > 0.0 ? apart.dot(covariance * apart) / length2 : covariance.trace();
}

/// Can two that were seen be these two of the map?
bool is_as_far_apart(const ObservedLandmark& first, const ObservedLandmark& second, const MapState& map,
                     int a, int b) {
  const Eigen::Vector2d seen = second.p_robot - first.p_robot;
  const Eigen::Vector2d known = landmark(map, b) - landmark(map, a);
  const Eigen::Matrix2d P = common(map, a, a) + common(map, b, b) - common(map, a, b) - common(map, b, a);
  const double nu = known.norm() - seen.norm();
  return nu * nu <=
         kGate1 * (variance_along(known, P) + variance_along(seen, first.covariance + second.covariance));
}

/// A pose that two landmarks give.
struct Hypothesis {
  int seen[2];
  int landmarks[2];
  Pose2 T_world_robot;
  Eigen::Vector2d centre;  ///< between the landmarks
  Eigen::Vector2d across;  ///< d heading / d landmark 1 = -d heading / d landmark 0
};

struct Match {
  int landmark = -1;
  double d2 = kPlaceGate;
};

class Search {
 public:
  Search(std::span<const ObservedLandmark> seen, const MapState& map) : seen_(seen), map_(map) {
    for (const ObservedLandmark& each : seen) candidates_.push_back(candidates(each.id));
  }

  PoseCandidates run() {
    for (int i = 0; i < std::ssize(seen_); ++i)
      for (int j = i + 1; j < std::ssize(seen_); ++j) propose_by(i, j);
    PoseCandidates found{std::move(best_), 0};
    for (const auto& [T, agreeing] : tried_)
      if (is_elsewhere(T, found.best.T_world_robot)) found.rival = std::max(found.rival, agreeing);
    if (found.best.agreeing > 0) found.best.T_world_robot = fit(found.best);
    return found;
  }

 private:
  [[nodiscard]] std::vector<int> candidates(const std::optional<LandmarkId>& id) const {
    std::vector<int> result;
    for (int i = 0; i < std::ssize(map_.ids); ++i)
      if (!id || map_.ids[as_index(i)] == *id) result.push_back(i);
    return result;
  }

  static bool is_elsewhere(const Pose2& a, const Pose2& b) {
    const Eigen::Vector3d apart = difference(a, b);
    return apart.head<2>().norm() > kElsewhere_m || std::abs(apart[2]) > kElsewhere_rad;
  }

  void propose_by(int i, int j) {
    for (const int a : candidates_[as_index(i)])
      for (const int b : candidates_[as_index(j)])
        if (a != b && is_long_enough(i, j, a, b) &&
            is_as_far_apart(seen_[as_index(i)], seen_[as_index(j)], map_, a, b))
          judge(hypothesis({i, j}, {a, b}));
  }

  /// To tell a heading.
  [[nodiscard]] bool is_long_enough(int i, int j, int a, int b) const {
    return (seen_[as_index(j)].p_robot - seen_[as_index(i)].p_robot).norm() >= kShortest_m &&
           (landmark(map_, b) - landmark(map_, a)).norm() >= kShortest_m;
  }

  [[nodiscard]] Hypothesis hypothesis(std::pair<int, int> seen, std::pair<int, int> landmarks) const {
    const Eigen::Vector2d p0 = seen_[as_index(seen.first)].p_robot;
    const Eigen::Vector2d p1 = seen_[as_index(seen.second)].p_robot;
    const Eigen::Vector2d m0 = landmark(map_, landmarks.first);
    const Eigen::Vector2d m1 = landmark(map_, landmarks.second);
    const double theta_rad = wrap_angle(angle_of(m1 - m0) - angle_of(p1 - p0));
    const Eigen::Vector2d centre = 0.5 * (m0 + m1);
    const Eigen::Vector2d t = centre - rotation_matrix(theta_rad) * (0.5 * (p0 + p1));
    return {{seen.first, seen.second},
            {landmarks.first, landmarks.second},
            {t.x(), t.y(), theta_rad},
            centre,
            perpendicular(m1 - m0) / (m1 - m0).squaredNorm()};
  }

  void judge(const Hypothesis& hypothesis) {
    PoseCandidate candidate{hypothesis.T_world_robot, std::vector<int>(seen_.size(), -1), 2};
    double misfit = 0.0;
    for (int k = 0; k < 2; ++k) candidate.landmarks[as_index(hypothesis.seen[k])] = hypothesis.landmarks[k];
    for (int k = 0; k < std::ssize(seen_); ++k) {
      if (candidate.landmarks[as_index(k)] >= 0) continue;
      const Match match = nearest(hypothesis, k, candidate.landmarks);
      candidate.landmarks[as_index(k)] = match.landmark;
      candidate.agreeing += match.landmark >= 0 ? 1 : 0;
      misfit += match.d2;
    }
    tried_.emplace_back(candidate.T_world_robot, candidate.agreeing);
    if (std::pair(-candidate.agreeing, misfit) >= std::pair(-best_.agreeing, best_misfit_)) return;
    best_ = std::move(candidate);
    best_misfit_ = misfit;
  }

  /// Of the landmarks that are still free.
  [[nodiscard]] Match nearest(const Hypothesis& hypothesis, int k, const std::vector<int>& taken) const {
    Match best;
    const Eigen::Vector2d p_world = hypothesis.T_world_robot * seen_[as_index(k)].p_robot;
    const Eigen::Vector2d lever = perpendicular(p_world - hypothesis.centre);
    const Eigen::Matrix2d A = 0.5 * Eigen::Matrix2d::Identity() - lever * hypothesis.across.transpose();
    const Eigen::Matrix2d B = Eigen::Matrix2d::Identity() - A;
    const Eigen::Matrix2d seen_covariance = covariance_of_seen(hypothesis, k, A, B);
    for (const int c : candidates_[as_index(k)]) {
      if (std::ranges::find(taken, c) != taken.end()) continue;
      const Eigen::Matrix2d S = seen_covariance + covariance_of_map(hypothesis, c, A, B);
      const auto d2 = mahalanobis_squared<2>(landmark(map_, c) - p_world, S);
      if (d2 && *d2 < best.d2) best = {c, *d2};
    }
    return best;
  }

  /// World frame, of what was seen itself and of the two that the pose is from.
  [[nodiscard]] Eigen::Matrix2d covariance_of_seen(const Hypothesis& hypothesis, int k,
                                                   const Eigen::Matrix2d& A, const Eigen::Matrix2d& B) const {
    const Eigen::Matrix2d R = hypothesis.T_world_robot.rotation();
    const auto turned = [&](int i) -> Eigen::Matrix2d {
      return R * seen_[as_index(i)].covariance * R.transpose();
    };
    return turned(k) + A * turned(hypothesis.seen[0]) * A.transpose() +
           B * turned(hypothesis.seen[1]) * B.transpose();
  }

  /// Of landmark c less A times the one and B times the other landmark of the hypothesis.
  [[nodiscard]] Eigen::Matrix2d covariance_of_map(const Hypothesis& hypothesis, int c,
                                                  const Eigen::Matrix2d& A, const Eigen::Matrix2d& B) const {
    const int rows[] = {c, hypothesis.landmarks[0], hypothesis.landmarks[1]};
    const Eigen::Matrix2d J[] = {Eigen::Matrix2d::Identity(), -A, -B};
    Eigen::Matrix2d sum = Eigen::Matrix2d::Zero();
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) sum += J[i] * common(map_, rows[i], rows[j]) * J[j].transpose();
    return sum;
  }

  /// Weighted least squares over all that agree (Horn 1987 in the plane).
  [[nodiscard]] Pose2 fit(const PoseCandidate& candidate) const {
    std::vector<std::pair<double, std::size_t>> weights;
    Eigen::Vector2d from = Eigen::Vector2d::Zero();
    Eigen::Vector2d to = Eigen::Vector2d::Zero();
    double total = 0.0;
    for (std::size_t k = 0; k < seen_.size(); ++k) {
      const int c = candidate.landmarks[k];
      if (c < 0) continue;
      const double weight = 1.0 / (seen_[k].covariance.trace() + common(map_, c, c).trace() + 1e-12);
      weights.emplace_back(weight, k);
      from += weight * seen_[k].p_robot;
      to += weight * landmark(map_, c);
      total += weight;
    }
    from /= total;
    to /= total;
    double cosine = 0.0;
    double sine = 0.0;
    for (const auto& [weight, k] : weights) {
      const Eigen::Vector2d p = seen_[k].p_robot - from;
      const Eigen::Vector2d m = landmark(map_, candidate.landmarks[k]) - to;
      cosine += weight * p.dot(m);
      sine += weight * perpendicular(p).dot(m);
    }
    const double theta_rad = std::atan2(sine, cosine);
    const Eigen::Vector2d t = to - rotation_matrix(theta_rad) * from;
    return {t.x(), t.y(), theta_rad};
  }

  std::span<const ObservedLandmark> seen_;
  const MapState& map_;
  std::vector<std::vector<int>> candidates_;  // landmarks that it may be, by what was seen
  std::vector<std::pair<Pose2, int>> tried_;  // poses, and how many agree
  PoseCandidate best_;
  double best_misfit_ = 0.0;
};

}  // namespace

PoseCandidates find_pose(std::span<const ObservedLandmark> seen, const MapState& map) {
  return Search(seen, map).run();
}

int count_contradictions(std::span<const ObservedLandmark> seen, const MapState& map) {
  std::vector<std::pair<const ObservedLandmark*, int>> known;
  for (const ObservedLandmark& each : seen) {
    const auto at = each.id && each.times > 1 ? std::ranges::find(map.ids, *each.id) : map.ids.end();
    if (at != map.ids.end()) known.emplace_back(&each, static_cast<int>(at - map.ids.begin()));
  }
  int count = 0;
  for (std::size_t i = 0; i < known.size(); ++i)
    for (std::size_t j = i + 1; j < known.size(); ++j)
      count += !is_as_far_apart(*known[i].first, *known[j].first, map, known[i].second, known[j].second);
  return count;
}

}  // namespace waymark
