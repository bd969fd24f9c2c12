#include "workbench/report/picture_text.hpp"

#include "workbench/logs/image_file.hpp"
#include "workbench/report/base64.hpp"

namespace waymark {

std::string picture_text(GreyImage picture) {
  std::uint8_t* pixels = picture.data();
  for (int i = 0; i < picture.width_px() * picture.height_px(); ++i)
    pixels[i] = static_cast<std::uint8_t>((pixels[i] & 0xF8U) | 4U);
  const auto png = encode_png(picture);
  return png ? base64(*png) : std::string();
}

}  // namespace waymark
