#pragma once

#include <string>

#include "waymark/core/grey_image.hpp"

namespace waymark {

/// A picture as a PNG file in base64, for a data URL. 32 shades are enough to look at, and half as many
/// bytes.
[[nodiscard]] std::string picture_text(GreyImage picture);

}  // namespace waymark
