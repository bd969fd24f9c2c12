#include "waymark/fastslam/landmark_point.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "support/matrix_near.hpp"

namespace waymark::fastslam {
namespace {

using kernels::LandmarkForm;
using kernels::LandmarkMode;
using kernels::LandmarkView;
using test::matrix_near;

/// A landmark of one particle.
class OneLandmark {
 public:
  OneLandmark(LandmarkForm form, const std::vector<std::vector<float>>& modes) : numbers_(modes) {
    for (auto& n : numbers_)
      modes_.push_back({{n.data(), &n[1], &n[2], &n[3], &n[4]}, n.size() > 5 ? &n[5] : nullptr});
    view_ = {form, 10.0F, 20.0F, &anchor_[0], &anchor_[1], modes_.data(), modes_.size()};
  }
  [[nodiscard]] PointGaussian point() const { return point_of(view_, 0); }

 private:
  std::vector<std::vector<float>> numbers_;
  float anchor_[2] = {1.0F, 2.0F};
  std::vector<LandmarkMode> modes_;
  LandmarkView view_;
};

TEST(PointOf, APointIsItself) {
  const PointGaussian p = OneLandmark(LandmarkForm::kPoint, {{0.5F, -0.25F, 0.04F, 0.01F, 0.09F}}).point();
  EXPECT_TRUE(matrix_near(p.mean, Eigen::Vector2d(10.5, 19.75), 1e-9));
  EXPECT_TRUE(matrix_near(p.covariance, Eigen::Matrix2d{{0.04, 0.01}, {0.01, 0.09}}, 1e-8));
}

TEST(PointOf, RaysAndRingsOfLittleSpreadArePropagatedToFirstOrder) {
  const double phi = 0.7;
  const Eigen::Vector2d f(std::cos(phi), std::sin(phi));
  const Eigen::Vector2d t(-f.y(), f.x());
  for (const LandmarkForm form : {LandmarkForm::kRay, LandmarkForm::kRing}) {
    const bool is_ray = form == LandmarkForm::kRay;
    const double b = is_ray ? 0.25 : 4.0;
    const double slope = is_ray ? -16.0 : 1.0;  // d(distance)/db at a distance of 4
    const Eigen::Matrix2d P{{1e-4, 2e-5 / slope}, {2e-5 / slope, 1e-4 / (slope * slope)}};
    const PointGaussian p = OneLandmark(form, {{0.7F, static_cast<float>(b), static_cast<float>(P(0, 0)),
                                                static_cast<float>(P(0, 1)), static_cast<float>(P(1, 1))}})
                                .point();
    Eigen::Matrix2d J;
    J << 4.0 * t, slope * f;
    EXPECT_TRUE(matrix_near(p.mean, Eigen::Vector2d(11.0, 22.0) + 4.0 * f, 1e-3));
    EXPECT_TRUE(matrix_near(p.covariance, J * P * J.transpose(), 1e-5));
  }
}

TEST(PointOf, ARayThatMayReachInfinityStaysFinite) {
  const PointGaussian p = OneLandmark(LandmarkForm::kRay, {{0.0F, 0.1F, 1e-4F, 0.0F, 0.01F}}).point();
  EXPECT_TRUE(p.mean.allFinite());
  EXPECT_TRUE(p.covariance.allFinite());
  EXPECT_GT(p.covariance(0, 0), 100.0);
}

TEST(PointOf, HypothesesAreOneGaussianOfTheirMoments) {
  const float dead = kernels::kDeadMode;
  const auto weight = [](double w) { return static_cast<float>(std::log(w)); };
  const PointGaussian p =
      OneLandmark(LandmarkForm::kRing, {{0.0F, 4.0F, 1e-8F, 0.0F, 1e-8F, weight(0.25)},
                                        {1.0F, 9.0F, 1e-8F, 0.0F, 1e-8F, dead},
                                        {static_cast<float>(M_PI), 4.0F, 1e-8F, 0.0F, 1e-8F, weight(0.75)}})
          .point();
  EXPECT_TRUE(matrix_near(p.mean, Eigen::Vector2d(11.0 - 2.0, 22.0), 1e-5));
  EXPECT_TRUE(matrix_near(p.covariance, Eigen::Matrix2d{{12.0, 0.0}, {0.0, 0.0}}, 1e-4));
}

}  // namespace
}  // namespace waymark::fastslam
