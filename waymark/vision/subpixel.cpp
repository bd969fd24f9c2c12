#include "waymark/vision/subpixel.hpp"

#include <algorithm>
#include <array>

#include <Eigen/LU>

#include "waymark/core/principal_axes.hpp"

namespace waymark::vision {
namespace {

using Scores = Eigen::Matrix3d;  ///< ZMSSD at (row, column) around the place

Scores scores_around(const ImageView& image, const Patch& patch, int u, int v,
                     kernels::Instructions instructions) {
  const std::array<kernels::WindowRow, 3> rows{kernels::WindowRow{0, 3}, {0, 3}, {0, 3}};
  std::array<std::uint32_t, 9> scores{};
  const int before = before_place(patch.size) + 1;
  kernels::zmssd_search_by(instructions)(patch.for_search(), image.pixel(u - before, v - before),
                                         image.stride, rows.data(), rows.size(), scores.data());
  Scores c;
  for (int k = 0; k < 9; ++k) c(k / 3, k % 3) = scores[static_cast<std::size_t>(k)];
  return c / (patch.size * patch.size);
}

/// The part of the ZMSSD of window i that goes away if patch d is multiplied by a, 1/2 to 2: with V = sum d^2
/// and C = sum d i, both without their means, V + V_i - 2 C becomes a^2 V + V_i - 2 a C, least at a = C/V.
double zmssd_of_contrast(const ImageView& image, const Patch& patch, int u, int v) {
  std::int64_t sum_d = 0, sum_i = 0, dd = 0, di = 0;
  for (int row = 0; row < patch.size; ++row) {
    const std::uint8_t* window =
        image.pixel(u - before_place(patch.size), v - before_place(patch.size) + row);
    for (int column = 0; column < patch.size; ++column) {
      const int d = patch(column, row), i = window[column];
      sum_d += d;
      sum_i += i;
      dd += d * d;
      di += d * i;
    }
  }
  const double n = patch.size * patch.size, mean_d = static_cast<double>(sum_d) / n;
  const double V = static_cast<double>(dd) - mean_d * static_cast<double>(sum_d);
  const double C = static_cast<double>(di) - mean_d * static_cast<double>(sum_i);
  if (V <= 0.0) return 0.0;
  const double a = std::clamp(C / V, 0.5, 2.0);
  return V - 2.0 * C - (a * a * V - 2.0 * a * C);
}

/// With eigenvalues of at least `least`.
Eigen::Matrix2d floored(const Eigen::Matrix2d& R, double least) {
  const auto [variances, directions] = principal_axes(R);
  if (variances[0] >= least) return R;
  return directions * variances.cwiseMax(least).asDiagonal() * directions.transpose();
}

}  // namespace

std::optional<SubpixelPeak> find_peak(const ImageView& image, const Patch& patch, int u, int v,
                                      double grey_sigma, kernels::Instructions instructions) {
  if (!patch_fits(image, u, v, patch.size, 1)) return std::nullopt;
  const Scores c = scores_around(image, patch, u, v, instructions);
  const Eigen::Vector2d gradient(0.5 * (c(1, 2) - c(1, 0)), 0.5 * (c(2, 1) - c(0, 1)));
  const double mixed = 0.25 * (c(2, 2) - c(2, 0) - c(0, 2) + c(0, 0));
  const Eigen::Matrix2d H{{c(1, 2) - 2.0 * c(1, 1) + c(1, 0), mixed},
                          {mixed, c(2, 1) - 2.0 * c(1, 1) + c(0, 1)}};
  if (H(0, 0) <= 0.0 || H.determinant() <= 0.0) return std::nullopt;
  const Eigen::Matrix2d H_inverse = H.inverse();
  const Eigen::Vector2d step = -H_inverse * gradient;
  if (step.cwiseAbs().maxCoeff() > 1.0) return std::nullopt;
  // Noise against texture, and the noise of one image against that of the other.
  const double pixels = patch.size * patch.size;
  const double zmssd =
      std::max(c(1, 1) + 0.5 * gradient.dot(step) - zmssd_of_contrast(image, patch, u, v), 0.0);
  const double variance = std::max(grey_sigma * grey_sigma, zmssd / (2.0 * (pixels - 1.0)));
  const Eigen::Matrix2d R =
      4.0 * variance * H_inverse + 2.0 * pixels * variance * variance * H_inverse * H_inverse;
  return SubpixelPeak{Eigen::Vector2d(u, v) + step, floored(R, kMinPixelSigma * kMinPixelSigma), zmssd};
}

Eigen::Matrix2d whole_pixel_covariance() {
  return Eigen::Matrix2d::Identity() * (1.0 / 12.0 + kMinPixelSigma * kMinPixelSigma);
}

}  // namespace waymark::vision
