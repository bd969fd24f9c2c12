#pragma once

#include "waymark/core/grey_image.hpp"

namespace waymark::vision {

/// Does an image show anything? Not where it is of another size than the camera's, half of it is black or
/// white, or it hardly varies: a covered lens, no light, too much of it. That a landmark is not found there
/// says nothing about the landmark. Looks at every eighth pixel of every eighth row; 2 us.
[[nodiscard]] bool is_usable(const ImageView& image, int width_px, int height_px, double grey_sigma);

}  // namespace waymark::vision
