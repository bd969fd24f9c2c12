#include "workbench/bags/image_messages.hpp"

#include <algorithm>
#include <array>
#include <memory>
#include <utility>

#include <fmt/format.h>

#include "workbench/logs/image_file.hpp"
#include "workbench/logs/text_lines.hpp"

namespace waymark::bag {
namespace {

constexpr std::string_view kImage = "sensor_msgs/Image";
constexpr std::string_view kCompressedImage = "sensor_msgs/CompressedImage";

using Byte = std::uint8_t;

/// Where an encoding keeps the colours of a pixel, or the one value that is grey already.
struct PixelLayout {
  std::string_view encoding;
  int bytes;  ///< of a pixel
  int red;    ///< places among them
  int green;
  int blue;
};

constexpr std::array kLayouts{PixelLayout{"mono8", 1, 0, 0, 0},  PixelLayout{"8UC1", 1, 0, 0, 0},
                              PixelLayout{"rgb8", 3, 0, 1, 2},   PixelLayout{"bgr8", 3, 2, 1, 0},
                              PixelLayout{"8UC3", 3, 2, 1, 0},   PixelLayout{"rgba8", 4, 0, 1, 2},
                              PixelLayout{"bgra8", 4, 2, 1, 0},  PixelLayout{"8UC4", 4, 2, 1, 0},
                              PixelLayout{"mono16", 2, 1, 1, 1}, PixelLayout{"yuv422_yuy2", 2, 0, 0, 0},
                              PixelLayout{"yuv422", 2, 1, 1, 1}};

struct RawImage {
  int width_px = 0;
  int height_px = 0;
  std::size_t step = 0;
  std::string_view data;

  [[nodiscard]] const Byte* row(int v) const {
    return reinterpret_cast<const Byte*>(data.data()) + static_cast<std::size_t>(v) * step;
  }
};

GreyImage mix(const RawImage& raw, const PixelLayout& layout) {
  GreyImage grey(raw.width_px, raw.height_px);
  for (int v = 0; v < raw.height_px; ++v) {
    const Byte* from = raw.row(v);
    Byte* to = grey.data() + grey.stride() * v;
    if (layout.red == layout.blue) {
      for (int u = 0; u < raw.width_px; ++u) to[u] = from[u * layout.bytes + layout.red];
    } else {
      for (int u = 0; u < raw.width_px; ++u, from += layout.bytes)
        to[u] = static_cast<Byte>(
            (299 * from[layout.red] + 587 * from[layout.green] + 114 * from[layout.blue] + 500) / 1000);
    }
  }
  return grey;
}

/// The weights 1 2 1 both ways take in each colour of the mosaic alike at every pixel, and move nothing.
GreyImage smooth_mosaic(const RawImage& raw) {
  const auto mirror = [](int i, int count) {
    return count == 1 ? 0 : i < 0 ? 1 : i >= count ? count - 2 : i;
  };
  GreyImage grey(raw.width_px, raw.height_px);
  std::vector<int> column(static_cast<std::size_t>(raw.width_px));
  for (int v = 0; v < raw.height_px; ++v) {
    const Byte* above = raw.row(mirror(v - 1, raw.height_px));
    const Byte* here = raw.row(v);
    const Byte* under = raw.row(mirror(v + 1, raw.height_px));
    for (int u = 0; u < raw.width_px; ++u)
      column[static_cast<std::size_t>(u)] = above[u] + 2 * here[u] + under[u];
    const auto at = [&](int u) { return column[static_cast<std::size_t>(mirror(u, raw.width_px))]; };
    for (int u = 0; u < raw.width_px; ++u)
      grey(u, v) = static_cast<Byte>((at(u - 1) + 2 * at(u) + at(u + 1) + 8) / 16);
  }
  return grey;
}

Result<GreyImage> to_grey(RawImage raw, std::string_view encoding, bool is_bigendian) {
  const auto found = std::ranges::find(kLayouts, encoding, &PixelLayout::encoding);
  const bool is_mosaic = encoding.starts_with("bayer_") && encoding.ends_with("8");
  if (found == kLayouts.end() && !is_mosaic)
    return Error{fmt::format("its image encoding {} is not supported", in_quotes(encoding))};
  PixelLayout layout = is_mosaic ? kLayouts[0] : *found;
  if (encoding == "mono16" && is_bigendian) layout.red = layout.green = layout.blue = 0;
  if (raw.width_px < 1 || raw.height_px < 1 || raw.width_px > kMaxImageSide_px ||
      raw.height_px > kMaxImageSide_px)
    return Error{fmt::format("it has {} x {} pixels", raw.width_px, raw.height_px)};
  const std::size_t row = static_cast<std::size_t>(raw.width_px) * static_cast<std::size_t>(layout.bytes);
  // Some publishers leave the step at 0; rows without gaps have only one length.
  if (raw.step == 0 && raw.data.size() == row * static_cast<std::size_t>(raw.height_px)) raw.step = row;
  if (raw.step < row || raw.data.size() < raw.step * (static_cast<std::size_t>(raw.height_px) - 1) + row)
    return Error{fmt::format("its {} bytes in rows of {} are too few for {} x {} pixels in {}",
                             raw.data.size(), raw.step, raw.width_px, raw.height_px, encoding)};
  return is_mosaic ? smooth_mosaic(raw) : mix(raw, layout);
}

int side_px(std::uint32_t side) {
  return static_cast<int>(std::min<std::uint32_t>(side, 2 * kMaxImageSide_px));
}

Result<EventContent> raw_content(const MessageDecoder& message, const std::string& name) {
  const RawImage raw{side_px(message.size(2)), side_px(message.size(3)), message.size(4), message.text(1)};
  auto grey = to_grey(raw, message.text(0), message.number(5) != 0.0);
  if (!grey) return grey.error();
  return EventContent(Image{name, std::make_shared<const GreyImage>(*std::move(grey))});
}

Result<EventContent> packed_content(const MessageDecoder& message, const std::string& name) {
  if (message.text(0).find("compressedDepth") != std::string_view::npos) return Error{"it is a depth image"};
  if (message.text(1).empty()) return Error{"it is empty"};
  return EventContent(Image{name, nullptr, std::make_shared<const std::string>(message.text(1))});
}

}  // namespace

bool is_image(std::string_view type) { return type == kImage || type == kCompressedImage; }

Result<TopicReader> image_reader(const Topic& topic) {
  const bool is_raw = topic.type == kImage;
  const auto wanted =
      is_raw ? WantedFields{after_stamp({"width", "height", "step", "is_bigendian"}), {"encoding", "data"}}
             : WantedFields{after_stamp({}), {"format", "data"}};
  auto decoder = MessageDecoder::make(topic, wanted);
  if (!decoder) return decoder.error();
  return TopicReader{*std::move(decoder), true, [name = topic.name, is_raw](const MessageDecoder& message) {
                       return is_raw ? raw_content(message, name) : packed_content(message, name);
                     }};
}

}  // namespace waymark::bag
