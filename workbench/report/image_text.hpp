#pragma once

#include <string>

#include "waymark/core/grey_image.hpp"

namespace waymark {

/// An image as a PNG file in base64, for a data URL. 32 shades are enough to look at, and half as many
/// bytes.
[[nodiscard]] std::string image_text(GreyImage image);

}  // namespace waymark
