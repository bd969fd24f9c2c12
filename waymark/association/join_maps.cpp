#include "waymark/association/join_maps.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "waymark/core/chi2.hpp"
#include "waymark/core/cholesky.hpp"
#include "waymark/core/solve_symmetric.hpp"
#include "waymark/core/text.hpp"

namespace waymark {
namespace {

using Eigen::Index;

constexpr double kConsistent = 0.999;
constexpr int kIterations = 10;
// How much less than the common landmarks is known of the frames before: nothing, as numbers go.
constexpr double kDiffuse = 1e6;
constexpr double kSameVariance_m2 = 1e-12;

struct Common {
  int first;
  int second;
};

std::vector<Common> common_landmarks(const MapState& first, const MapState& second) {
  std::vector<Common> common;
  for (std::size_t i = 0; i < second.ids.size(); ++i) {
    const auto found = std::ranges::find(first.ids, second.ids[i]);
    if (second.ids[i].family != LandmarkId::Family::kNone && found != first.ids.end())
      common.push_back({static_cast<int>(found - first.ids.begin()), static_cast<int>(i)});
  }
  return common;
}

/// Where in mean and covariance a landmark stands.
Index row(int landmark) { return 3 + 2 * Index{landmark}; }

/// Mean and covariance of (pose, landmarks) in another frame, and their Jacobian to (x, y, theta) of T.
struct Moved {
  Eigen::VectorXd mean;
  Eigen::MatrixXd covariance;
  Eigen::MatrixXd J;
};

Moved move(const MapState& map, const Pose2& T) {
  const Index n = map.covariance.rows();
  const Eigen::Matrix2d R = T.rotation();
  Moved moved{mean_of(map), map.covariance, Eigen::MatrixXd::Zero(n, 3)};
  const auto move_point = [&](Index at) {
    const Eigen::Vector2d turned = R * moved.mean.segment<2>(at);
    moved.mean.segment<2>(at) = turned + T.position();
    moved.covariance.middleRows<2>(at) = (R * moved.covariance.middleRows<2>(at)).eval();
    moved.covariance.middleCols<2>(at) = (moved.covariance.middleCols<2>(at) * R.transpose()).eval();
    moved.J.block<2, 2>(at, 0).setIdentity();
    moved.J.block<2, 1>(at, 2) = perpendicular(turned);
  };
  move_point(0);
  moved.mean[2] += T.theta_rad;
  moved.J(2, 2) = 1.0;
  for (Index at = 3; at < n; at += 2) move_point(at);
  return moved;
}

/// What the first map says of the common landmarks less what the second does, given how their frames lie.
struct Apart {
  Eigen::VectorXd d;
  Eigen::MatrixXd S;
  Eigen::MatrixXd J;  ///< of the second map's part to T
};

Apart compare(const MapState& first, const Moved& second, const std::vector<Common>& common) {
  const auto size = 2 * std::ssize(common);
  Apart apart{Eigen::VectorXd(size), Eigen::MatrixXd(size, size), Eigen::MatrixXd(size, 3)};
  for (Index i = 0; i < std::ssize(common); ++i) {
    const auto& [a, b] = common[static_cast<std::size_t>(i)];
    apart.d.segment<2>(2 * i) = first.landmarks.segment<2>(2 * a) - second.mean.segment<2>(row(b));
    apart.J.middleRows<2>(2 * i) = second.J.middleRows<2>(row(b));
    for (Index j = 0; j < std::ssize(common); ++j) {
      const auto& [c, e] = common[static_cast<std::size_t>(j)];
      apart.S.block<2, 2>(2 * i, 2 * j) =
          first.covariance.block<2, 2>(row(a), row(c)) + second.covariance.block<2, 2>(row(b), row(e));
    }
  }
  apart.S.diagonal().array() += kSameVariance_m2;
  return apart;
}

/// Least squares, all landmarks alike.
Pose2 rough_fit(const MapState& first, const MapState& second, const std::vector<Common>& common) {
  Eigen::Vector2d to = Eigen::Vector2d::Zero();
  Eigen::Vector2d from = Eigen::Vector2d::Zero();
  for (const auto& [a, b] : common) {
    to += first.landmarks.segment<2>(2 * a) / static_cast<double>(common.size());
    from += second.landmarks.segment<2>(2 * b) / static_cast<double>(common.size());
  }
  double cosine = 0.0;
  double sine = 0.0;
  for (const auto& [a, b] : common) {
    const Eigen::Vector2d p = second.landmarks.segment<2>(2 * b) - from;
    const Eigen::Vector2d q = first.landmarks.segment<2>(2 * a) - to;
    cosine += p.dot(q);
    sine += perpendicular(p).dot(q);
  }
  const double theta_rad = std::atan2(sine, cosine);
  const Eigen::Vector2d t = to - rotation_matrix(theta_rad) * from;
  return {t.x(), t.y(), theta_rad};
}

/// How the frames lie, by generalised least squares.
struct Fit {
  Pose2 T;
  Moved second;
  Apart apart;
  Eigen::Matrix3d covariance;
  double d2 = 0.0;
};

Fit fit(const MapState& first, const MapState& second, const std::vector<Common>& common) {
  Fit fit;
  fit.T = rough_fit(first, second, common);
  for (int i = 0; i <= kIterations; ++i) {
    fit.second = move(second, fit.T);
    fit.apart = compare(first, fit.second, common);
    const Cholesky S(fit.apart.S);
    const Eigen::MatrixXd weighted = S.solve(fit.apart.J);
    const Eigen::Matrix3d information = fit.apart.J.transpose() * weighted;
    fit.covariance = solve_symmetric(information, Eigen::Matrix3d::Identity());
    fit.d2 = fit.apart.d.dot(S.solve(fit.apart.d));
    if (i == kIterations) break;
    const Eigen::Vector3d step = fit.covariance * (weighted.transpose() * fit.apart.d);
    fit.T = {fit.T.x_m + step.x(), fit.T.y_m + step.y(), wrap_angle(fit.T.theta_rad + step.z())};
  }
  return fit;
}

/// The common landmark that the maps put most differently.
LandmarkId worst(const MapState& first, const Apart& apart, const std::vector<Common>& common) {
  const auto misfit = [&](const Common& each) {
    const Index at = 2 * (&each - common.data());
    const Eigen::Vector2d d = apart.d.segment<2>(at);
    return d.dot(apart.S.block<2, 2>(at, at).llt().solve(d));
  };
  return first.ids[static_cast<std::size_t>(std::ranges::max_element(common, {}, misfit)->first)];
}

/// Both beliefs side by side, corrected by that common landmarks are one.
struct Joint {
  Eigen::VectorXd mean;
  Eigen::MatrixXd covariance;
};

Joint correct(const MapState& first, const Fit& fit, const std::vector<Common>& common) {
  const Index n = first.covariance.rows();
  const Index m = fit.second.covariance.rows();
  const Eigen::Matrix3d P_T = kDiffuse * fit.covariance;
  Joint joint{Eigen::VectorXd(n + m), Eigen::MatrixXd::Zero(n + m, n + m)};
  joint.mean << mean_of(first), fit.second.mean;
  joint.covariance.topLeftCorner(n, n) = first.covariance;
  joint.covariance.bottomRightCorner(m, m) =
      fit.second.covariance + fit.second.J * P_T * fit.second.J.transpose();
  Eigen::MatrixXd PH(n + m, 2 * std::ssize(common));
  for (Index i = 0; i < std::ssize(common); ++i) {
    const auto& [a, b] = common[static_cast<std::size_t>(i)];
    PH.middleCols<2>(2 * i) =
        joint.covariance.middleCols<2>(row(a)) - joint.covariance.middleCols<2>(n + row(b));
  }
  const Eigen::MatrixXd S = fit.apart.S + fit.apart.J * P_T * fit.apart.J.transpose();
  const Cholesky cholesky(S);
  joint.mean -= PH * cholesky.solve(fit.apart.d);
  const Eigen::MatrixXd W = cholesky.whiten(Eigen::MatrixXd(PH.transpose()));
  joint.covariance -= W.transpose() * W;
  joint.covariance = (0.5 * (joint.covariance + joint.covariance.transpose())).eval();
  return joint;
}

/// The landmarks of the first map, then those that only the second has.
MapState pick(const MapState& first, const MapState& second, const std::vector<Common>& common,
              const Joint& joint, PoseOf pose) {
  const Index n = first.covariance.rows();
  MapState map = pose == PoseOf::kFirst ? first : second;
  map.ids = first.ids;
  map.observations = first.observations;
  const Index pose_row = pose == PoseOf::kFirst ? 0 : n;
  std::vector<Index> rows{pose_row, pose_row + 1, pose_row + 2};
  for (Index i = 3; i < n; ++i) rows.push_back(i);
  for (int i = 0; i < std::ssize(second.ids); ++i) {
    const auto& landmark_observations = second.observations[static_cast<std::size_t>(i)];
    const auto twin = std::ranges::find(common, i, &Common::second);
    if (twin != common.end()) {
      map.observations[static_cast<std::size_t>(twin->first)] += landmark_observations;
      continue;
    }
    map.ids.push_back(second.ids[static_cast<std::size_t>(i)]);
    map.observations.push_back(landmark_observations);
    rows.insert(rows.end(), {n + row(i), n + row(i) + 1});
  }
  const Eigen::VectorXd mean = joint.mean(rows);
  map.T_world_robot = {mean[0], mean[1], wrap_angle(mean[2])};
  map.landmarks = mean.tail(mean.size() - 3);
  map.covariance = joint.covariance(rows, rows);
  return map;
}

}  // namespace

Result<JoinedMap> join_maps(const MapState& first, const MapState& second, PoseOf pose) {
  if (first.landmark_dimension != 2 || second.landmark_dimension != 2)
    return Error{"only maps with landmarks of dimension 2 can be joined"};
  const auto common = common_landmarks(first, second);
  if (common.size() < 2)
    return Error{concat("the maps have ", common.size(),
                        " landmarks in common by identity; two are needed to join them")};
  const Fit found = fit(first, second, common);
  const int dof = 2 * static_cast<int>(common.size()) - 3;
  const double limit = chi2_quantile(kConsistent, dof);
  if (!(found.d2 <= limit))
    return Error{concat("the maps contradict each other: chi-square ", decimals(found.d2, 1), " with ", dof,
                        " degrees of freedom for ", common.size(), " common landmarks, ", decimals(limit, 1),
                        " allowed; worst is landmark ", to_string(worst(first, found.apart, common)))};
  return JoinedMap{pick(first, second, common, correct(first, found, common), pose),
                   static_cast<int>(common.size()), found.T, found.d2, dof};
}

}  // namespace waymark
