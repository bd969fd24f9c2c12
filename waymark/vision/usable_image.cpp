#include "waymark/vision/usable_image.hpp"

namespace waymark::vision {

bool is_usable(const ImageView& image, int width_px, int height_px, double grey_sigma) {
  if (image.data == nullptr || image.empty() || image.width_px != width_px || image.height_px != height_px)
    return false;
  constexpr int kStep = 8;
  constexpr double kMinContrast = 2.0;  // times the noise of a pixel
  double n = 0.0, sum = 0.0, squares = 0.0, clipped = 0.0;
  for (int v = kStep / 2; v < height_px; v += kStep) {
    for (int u = kStep / 2; u < width_px; u += kStep) {
      const double grey = image(u, v);
      n += 1.0;
      sum += grey;
      squares += grey * grey;
      clipped += grey <= 1.0 || grey >= 254.0;
    }
  }
  const double variance = squares / n - sum / n * sum / n;
  return clipped <= 0.5 * n && variance > kMinContrast * kMinContrast * grey_sigma * grey_sigma;
}

}  // namespace waymark::vision
