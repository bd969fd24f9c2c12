#pragma once

#include "workbench/bags/topic_reader.hpp"

namespace waymark::bag {

[[nodiscard]] bool is_image(std::string_view type);

/// sensor_msgs/Image as grey pixels, CompressedImage (JPEG or PNG) as it is, for who wants its pixels. Grey
/// is 0.299 R + 0.587 G + 0.114 B; of a Bayer mosaic each pixel is the mean about it, (R + 2 G + B) / 4. 16
/// bits lose their lower 8. Known encodings: mono8, mono16, rgb8, bgr8, rgba8, bgra8, 8UC1, 8UC3, 8UC4,
/// bayer_*8, yuv422 and yuv422_yuy2; others, as of depth images, are an error of the message.
[[nodiscard]] Result<TopicReader> image_reader(const Topic& topic);

}  // namespace waymark::bag
