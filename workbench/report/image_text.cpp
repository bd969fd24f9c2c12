#include "workbench/report/image_text.hpp"

#include "workbench/logs/image_file.hpp"
#include "workbench/report/base64.hpp"

namespace waymark {

std::string image_text(GreyImage image) {
  std::uint8_t* pixels = image.data();
  for (int i = 0; i < image.width_px() * image.height_px(); ++i)
    pixels[i] = static_cast<std::uint8_t>((pixels[i] & 0xF8U) | 4U);
  const auto png = encode_png(image);
  return png ? base64(*png) : std::string();
}

}  // namespace waymark
