#include "waymark/fastslam/landmark_point.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Cholesky>

namespace waymark::fastslam {
namespace {

using kernels::LandmarkForm;

struct Node {
  double at;  // in standard deviations
  double weight;
};
const std::array<Node, 3> kHermite{
    {{-std::sqrt(3.0), 1.0 / 6.0}, {0.0, 2.0 / 3.0}, {std::sqrt(3.0), 1.0 / 6.0}}};

// A hypothesis that reaches infinity ends there: this many times as far as its mean says.
constexpr double kFarthest = 20.0;

/// Adds up weighted points and their spread.
class Moments {
 public:
  void add(double weight, const Eigen::Vector2d& mean, const Eigen::Matrix2d& covariance) {
    weight_ += weight;
    first_ += weight * mean;
    second_ += weight * (covariance + mean * mean.transpose());
  }
  [[nodiscard]] PointGaussian gaussian() const {
    const Eigen::Vector2d mean = first_ / weight_;
    return {mean, second_ / weight_ - mean * mean.transpose()};
  }

 private:
  double weight_ = 0.0;
  Eigen::Vector2d first_ = Eigen::Vector2d::Zero();
  Eigen::Matrix2d second_ = Eigen::Matrix2d::Zero();
};

struct Numbers {
  Eigen::Vector2d mean;
  Eigen::Matrix2d covariance;
};

Numbers numbers_of(const kernels::GaussianColumns& m, std::size_t i) {
  const auto at = [i](const float* column) { return static_cast<double>(column[i]); };
  return {{at(m.a), at(m.b)}, Eigen::Matrix2d{{at(m.aa), at(m.ab)}, {at(m.ab), at(m.bb)}}};
}

/// From the anchor.
Eigen::Vector2d end_of(LandmarkForm form, const Eigen::Vector2d& y, double mean_rho) {
  const double distance = form == LandmarkForm::kRay ? 1.0 / std::max(y[1], mean_rho / kFarthest) : y[1];
  return distance * Eigen::Vector2d(std::cos(y[0]), std::sin(y[0]));
}

PointGaussian point_of(LandmarkForm form, const Numbers& m) {
  if (form == LandmarkForm::kPoint) return {m.mean, m.covariance};
  const Eigen::Matrix2d L = m.covariance.llt().matrixL();
  Moments moments;
  for (const Node& u : kHermite)
    for (const Node& v : kHermite)
      moments.add(u.weight * v.weight,
                  end_of(form, m.mean + L * Eigen::Vector2d(u.at, v.at), std::max(m.mean[1], 1e-3)),
                  Eigen::Matrix2d::Zero());
  return moments.gaussian();
}

}  // namespace

PointGaussian point_of(const kernels::LandmarkView& landmark, std::size_t place) {
  Moments mixture;
  for (std::size_t k = 0; k < landmark.mode_count; ++k) {
    const kernels::LandmarkMode& mode = landmark.modes[k];
    const double weight =
        landmark.mode_count == 1 ? 1.0 : std::exp(static_cast<double>(mode.log_weight[place]));
    if (!(weight > 0.0)) continue;
    const PointGaussian point = point_of(landmark.form, numbers_of(mode.gaussian, place));
    mixture.add(weight, point.mean, point.covariance);
  }
  PointGaussian point = mixture.gaussian();
  point.mean += Eigen::Vector2d(landmark.offset_x, landmark.offset_y);
  if (landmark.form != LandmarkForm::kPoint)
    point.mean += Eigen::Vector2d(landmark.anchor_x[place], landmark.anchor_y[place]);
  return point;
}

}  // namespace waymark::fastslam
