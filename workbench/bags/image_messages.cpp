#include "workbench/bags/image_messages.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cctype>
#include <cstddef>
#include <memory>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "workbench/bags/byte_reader.hpp"
#include "workbench/logs/image_file.hpp"
#include "workbench/logs/text_lines.hpp"
#include "workbench/logs/used_bits.hpp"

namespace waymark::bag {
namespace {

constexpr std::string_view kImage = "sensor_msgs/Image";
constexpr std::string_view kCompressedImage = "sensor_msgs/CompressedImage";

using Byte = std::uint8_t;

/// Where an encoding keeps the colours of a pixel, or the one value that is grey already.
struct PixelLayout {
  std::string_view encoding;  ///< in small letters
  int samples;                ///< of a pixel; a fourth is opacity
  int red;                    ///< places among them
  int green;
  int blue;
  int sample_bytes = 1;
  int half_planes = 2;  ///< bytes of all planes, in halves of the first, which is grey
};

constexpr std::array kLayouts{
    PixelLayout{"mono8", 1, 0, 0, 0},      PixelLayout{"8uc1", 1, 0, 0, 0},
    PixelLayout{"rgb8", 3, 0, 1, 2},       PixelLayout{"bgr8", 3, 2, 1, 0},
    PixelLayout{"8uc3", 3, 2, 1, 0},       PixelLayout{"rgba8", 4, 0, 1, 2},
    PixelLayout{"bgra8", 4, 2, 1, 0},      PixelLayout{"8uc4", 4, 2, 1, 0},
    PixelLayout{"mono16", 1, 0, 0, 0, 2},  PixelLayout{"rgb16", 3, 0, 1, 2, 2},
    PixelLayout{"bgr16", 3, 2, 1, 0, 2},   PixelLayout{"16uc3", 3, 2, 1, 0, 2},
    PixelLayout{"rgba16", 4, 0, 1, 2, 2},  PixelLayout{"bgra16", 4, 2, 1, 0, 2},
    PixelLayout{"16uc4", 4, 2, 1, 0, 2},   PixelLayout{"yuv422", 2, 1, 1, 1},
    PixelLayout{"uyvy", 2, 1, 1, 1},       PixelLayout{"yuv422_yuy2", 2, 0, 0, 0},
    PixelLayout{"yuyv", 2, 0, 0, 0},       PixelLayout{"nv12", 1, 0, 0, 0, 1, 3},
    PixelLayout{"nv21", 1, 0, 0, 0, 1, 3}, PixelLayout{"i420", 1, 0, 0, 0, 1, 3},
    PixelLayout{"nv16", 1, 0, 0, 0, 1, 4}, PixelLayout{"nv24", 1, 0, 0, 0, 1, 6},
};
constexpr PixelLayout kMosaic8{"bayer_*8", 1, 0, 0, 0};
constexpr PixelLayout kMosaic16{"bayer_*16", 1, 0, 0, 0, 2};

bool is_mosaic(const PixelLayout& layout) { return layout.encoding.starts_with("bayer_"); }

/// Large and small letters are alike.
std::optional<PixelLayout> layout_of(std::string_view encoding) {
  std::string name(encoding);
  std::ranges::transform(name, name.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (name.starts_with("bayer_") && name.ends_with("16")) return kMosaic16;
  if (name.starts_with("bayer_") && name.ends_with("8")) return kMosaic8;
  const auto found = std::ranges::find(kLayouts, name, &PixelLayout::encoding);
  return found == kLayouts.end() ? std::nullopt : std::optional(*found);
}

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
      for (int u = 0; u < raw.width_px; ++u) to[u] = from[u * layout.samples + layout.red];
    } else {
      for (int u = 0; u < raw.width_px; ++u, from += layout.samples)
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

/// Calls `visit` with the place of each sample of 16 bits that is no opacity, and its value.
template <class Visit>
void each_colour(const RawImage& raw, const PixelLayout& layout, std::endian order, const Visit& visit) {
  const int colours = std::min(layout.samples, 3);
  std::size_t place = 0;
  for (int v = 0; v < raw.height_px; ++v) {
    const auto* from = reinterpret_cast<const char*>(raw.row(v));
    for (int u = 0; u < raw.width_px; ++u, place += static_cast<std::size_t>(layout.samples))
      for (int k = 0; k < colours; ++k)
        visit(place + static_cast<std::size_t>(k),
              load<std::uint16_t>(from + std::ptrdiff_t{2} * (u * layout.samples + k), order));
  }
}

/// The samples of an image of 16 bits as 8, without gaps, by the bits that the camera uses.
std::string narrow(const RawImage& raw, const PixelLayout& layout, std::endian order, UsedBits& bits) {
  std::uint16_t largest = 0;
  each_colour(raw, layout, order,
              [&](std::size_t, std::uint16_t value) { largest = std::max(largest, value); });
  const int shift = bits.shift(largest);
  std::string samples(static_cast<std::size_t>(raw.width_px) * static_cast<std::size_t>(raw.height_px) *
                          static_cast<std::size_t>(layout.samples),
                      '\0');
  each_colour(raw, layout, order, [&](std::size_t place, std::uint16_t value) {
    samples[place] = static_cast<char>(value >> shift);
  });
  return samples;
}

GreyImage to_grey(const RawImage& raw, const PixelLayout& layout) {
  return is_mosaic(layout) ? smooth_mosaic(raw) : mix(raw, layout);
}

/// The image with a step that fits its bytes.
Result<RawImage> with_whole_rows(RawImage raw, const PixelLayout& layout) {
  if (raw.width_px < 1 || raw.height_px < 1 || raw.width_px > kMaxImageSide_px ||
      raw.height_px > kMaxImageSide_px)
    return Error{fmt::format("it has {} x {} pixels", raw.width_px, raw.height_px)};
  const auto height = static_cast<std::size_t>(raw.height_px);
  const std::size_t row = static_cast<std::size_t>(raw.width_px) * static_cast<std::size_t>(layout.samples) *
                          static_cast<std::size_t>(layout.sample_bytes);
  // Some publishers leave the step at 0, or divide all planes by the rows of one; rows without gaps have only
  // one length.
  if (2 * raw.data.size() == row * height * static_cast<std::size_t>(layout.half_planes)) raw.step = row;
  if (raw.step < row || raw.data.size() < raw.step * (height - 1) + row)
    return Error{fmt::format("its {} bytes in rows of {} are too few for {} x {} pixels in {}",
                             raw.data.size(), raw.step, raw.width_px, raw.height_px, layout.encoding)};
  return raw;
}

Result<GreyImage> to_grey(const RawImage& claimed, std::string_view encoding, std::endian order,
                          UsedBits& bits) {
  const auto layout = layout_of(encoding);
  if (!layout) return Error{fmt::format("its image encoding {} is not supported", in_quotes(encoding))};
  const auto raw = with_whole_rows(claimed, *layout);
  if (!raw) return raw.error();
  if (layout->sample_bytes == 1) return to_grey(*raw, *layout);
  const std::string samples = narrow(*raw, *layout, order, bits);
  const std::size_t step =
      static_cast<std::size_t>(raw->width_px) * static_cast<std::size_t>(layout->samples);
  return to_grey({raw->width_px, raw->height_px, step, samples}, *layout);
}

int side_px(std::uint32_t side) {
  return static_cast<int>(std::min<std::uint32_t>(side, 2 * kMaxImageSide_px));
}

Result<EventContent> raw_content(const MessageDecoder& message, const std::string& name, UsedBits& bits) {
  const RawImage raw{side_px(message.size(2)), side_px(message.size(3)), message.size(4), message.text(1)};
  const std::endian order = message.number(5) != 0.0 ? std::endian::big : std::endian::little;
  auto grey = to_grey(raw, message.text(0), order, bits);
  if (!grey) return grey.error();
  return EventContent(Image{name, std::make_shared<const GreyImage>(*std::move(grey))});
}

/// "16UC1; png compressedDepth ", "16UC1; png compressed"
bool is_depth(std::string_view format) {
  return format.find("compressedDepth") != std::string_view::npos || format.starts_with("16UC1") ||
         format.starts_with("32FC1");
}

Result<EventContent> packed_content(const MessageDecoder& message, const std::string& name) {
  const std::string_view format = message.text(0), bytes = message.text(1);
  if (is_depth(format)) return Error{"it is a depth image"};
  if (bytes.empty()) return Error{"it is empty"};
  if (!is_image_file(bytes))
    return Error{fmt::format("its format {} is not supported; only JPEG and PNG are", in_quotes(format))};
  return EventContent(Image{name, nullptr, std::make_shared<const std::string>(bytes)});
}

std::vector<std::string> notes_on(const UsedBits& bits, const std::string& name) {
  if (bits.note().empty()) return {};
  return {fmt::format("{}: the camera {}; its grey values are scaled accordingly", name, bits.note())};
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
  const auto bits = std::make_shared<UsedBits>();
  return TopicReader{*std::move(decoder), true,
                     [name = topic.name, is_raw, bits](const MessageDecoder& message) {
                       return is_raw ? raw_content(message, name, *bits) : packed_content(message, name);
                     },
                     [name = topic.name, bits] { return notes_on(*bits, name); }};
}

}  // namespace waymark::bag
