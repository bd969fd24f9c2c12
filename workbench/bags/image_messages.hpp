#pragma once

#include "workbench/bags/topic_reader.hpp"

namespace waymark::bag {

[[nodiscard]] bool is_image(std::string_view type);

/// sensor_msgs/Image as grey pixels, CompressedImage (JPEG or PNG) as it is, for who wants its pixels. Grey
/// is 0.299 R + 0.587 G + 0.114 B; of YUV it is Y, and of a Bayer mosaic each pixel is the mean about it, (R
/// + 2 G + B) / 4. 16 bits become 8 by the bits that the camera uses (UsedBits), and the reader's notes say
/// so. Known encodings, in large or small letters: mono, rgb, bgr, rgba, bgra and bayer_* of 8 and 16 bits,
/// 8UC1, 8UC3, 8UC4, 16UC3, 16UC4, yuv422, uyvy, yuv422_yuy2, yuyv, nv12, nv16, nv21, nv24 and i420; others,
/// as of depth images, are an error of the message that names them.
[[nodiscard]] Result<TopicReader> image_reader(const Topic& topic);

}  // namespace waymark::bag
