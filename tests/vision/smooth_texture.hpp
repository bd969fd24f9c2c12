#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Core>

#include "waymark/core/angle.hpp"
#include "waymark/core/grey_image.hpp"
#include "waymark/core/random.hpp"

namespace waymark::test {

/// An image known at every place between its pixels: waves of all directions, none shorter than six pixels.
class SmoothTexture {
 public:
  explicit SmoothTexture(RandomStream& random, double contrast = 12.0) {
    for (int i = 0; i < 30; ++i) {
      const double period_px = random.uniform(6.0, 25.0), direction = random.uniform(0.0, kPi);
      waves_.push_back({Eigen::Vector2d(std::cos(direction), std::sin(direction)) * (2.0 * kPi / period_px),
                        random.uniform(0.0, 2.0 * kPi), contrast * random.uniform(0.2, 1.0)});
    }
  }

  [[nodiscard]] double operator()(const Eigen::Vector2d& place) const {
    double grey = 128.0;
    for (const Wave& w : waves_) grey += w.height * std::sin(w.number.dot(place) + w.phase);
    return grey;
  }

  /// As a camera with grey noise sees it: pixel p shows the place A p + t.
  [[nodiscard]] GreyImage seen(int width_px, int height_px, const Eigen::Matrix2d& A,
                               const Eigen::Vector2d& t, double grey_sigma, RandomStream& random) const {
    GreyImage image(width_px, height_px);
    for (int v = 0; v < height_px; ++v) {
      for (int u = 0; u < width_px; ++u) {
        const double grey = (*this)(A * Eigen::Vector2d(u, v) + t) + grey_sigma * random.normal();
        image(u, v) = static_cast<std::uint8_t>(std::clamp(std::lround(grey), 0L, 255L));
      }
    }
    return image;
  }

 private:
  struct Wave {
    Eigen::Vector2d number;
    double phase;
    double height;
  };
  std::vector<Wave> waves_;
};

}  // namespace waymark::test
