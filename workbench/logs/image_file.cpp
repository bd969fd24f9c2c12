#include "workbench/logs/image_file.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <csetjmp>
#include <cstdio>
#include <vector>

#include <fmt/format.h>
#include <jerror.h>
#include <jpeglib.h>
#include <png.h>

#include "workbench/logs/deep_image.hpp"
#include "workbench/logs/files.hpp"

namespace waymark {
namespace {

Error damaged(const std::string& name, std::string_view kind, std::string_view why) {
  return {fmt::format("{}: damaged {} file: {}", name, kind, why)};
}

Result<void> check_size(ImageSize size, const std::string& name, std::optional<ImageSize> expected) {
  if (expected && size != *expected)
    return Error{fmt::format("{}: the image has {} x {} pixels, expected {} x {}", name, size.width_px,
                             size.height_px, expected->width_px, expected->height_px)};
  if (size.width_px < 1 || size.height_px < 1 || size.width_px > kMaxImageSide_px ||
      size.height_px > kMaxImageSide_px)
    return Error{fmt::format("{}: an image of {} x {} pixels; each side must have 1 to {}", name,
                             size.width_px, size.height_px, kMaxImageSide_px)};
  return {};
}

/// Frees what libpng holds, whatever way a function is left.
struct PngImage : png_image {
  PngImage() : png_image{} { version = PNG_IMAGE_VERSION; }
  PngImage(const PngImage&) = delete;
  PngImage& operator=(const PngImage&) = delete;
  ~PngImage() { png_image_free(this); }
};

constexpr int grey_of(const std::uint8_t* rgb) {
  return (299 * rgb[0] + 587 * rgb[1] + 114 * rgb[2] + 500) / 1000;
}

Result<GreyImage> decode_png(std::string_view bytes, const std::string& name,
                             std::optional<ImageSize> expected, UsedBits& bits) {
  PngImage png;
  if (png_image_begin_read_from_memory(&png, bytes.data(), bytes.size()) == 0)
    return damaged(name, "PNG", png.message);
  const ImageSize size{static_cast<int>(png.width), static_cast<int>(png.height)};
  if (auto fits = check_size(size, name, expected); !fits) return fits.error();
  if ((png.format & PNG_FORMAT_FLAG_LINEAR) != 0) {  // so libpng calls samples of 16 bits
    const auto deep = decode_deep_png(bytes);
    return deep ? Result<GreyImage>(to_grey(*deep, bits)) : damaged(name, "PNG", deep.error().message);
  }
  // libpng's own grey is a mean of light, not of the stored values: see the three colours, mix them here.
  png.format = PNG_FORMAT_RGB;
  std::vector<png_byte> rgb(PNG_IMAGE_SIZE(png));
  const png_color black{0, 0, 0};
  if (png_image_finish_read(&png, &black, rgb.data(), 0, nullptr) == 0)
    return damaged(name, "PNG", png.message);
  GreyImage image(size.width_px, size.height_px);
  for (std::size_t i = 0; i < rgb.size() / 3; ++i)
    image.data()[i] = static_cast<std::uint8_t>(grey_of(&rgb[3 * i]));
  return image;
}

/// libjpeg reports errors by a call that must not return.
struct JpegErrors : jpeg_error_mgr {
  std::jmp_buf leave;
  bool cut_off = false;
  char text[JMSG_LENGTH_MAX] = "";
};

void leave_jpeg(j_common_ptr jpeg) {
  auto* errors = static_cast<JpegErrors*>(jpeg->err);
  errors->format_message(jpeg, errors->text);
  std::longjmp(errors->leave, 1);
}

/// What is missing of a file is filled with grey under a mere warning; other warnings are of files that many
/// cameras make.
void note_jpeg_warning(j_common_ptr jpeg, int level) {
  auto* errors = static_cast<JpegErrors*>(jpeg->err);
  if (level >= 0 || (errors->msg_code != JWRN_JPEG_EOF && errors->msg_code != JWRN_HIT_MARKER)) return;
  errors->cut_off = true;
  errors->format_message(jpeg, errors->text);
}

/// One decoder, freed whatever way a function is left.
class JpegDecoder {
 public:
  explicit JpegDecoder(std::string_view bytes) : bytes_(bytes) {
    jpeg_.err = jpeg_std_error(&errors_);
    errors_.error_exit = leave_jpeg;
    errors_.emit_message = note_jpeg_warning;
  }
  JpegDecoder(const JpegDecoder&) = delete;
  JpegDecoder& operator=(const JpegDecoder&) = delete;
  ~JpegDecoder() { jpeg_destroy_decompress(&jpeg_); }

  // In both functions nothing that needs destruction lives when libjpeg jumps out.
  bool read_header() {
    if (setjmp(errors_.leave) != 0) return false;
    jpeg_create_decompress(&jpeg_);
    jpeg_mem_src(&jpeg_, reinterpret_cast<const unsigned char*>(bytes_.data()), bytes_.size());
    jpeg_read_header(&jpeg_, TRUE);
    return true;
  }
  /// The luminance of a JPEG file is the grey that we want; one with printing inks has none. `inks` holds a
  /// row of these, 4 bytes a pixel.
  bool read_grey(std::uint8_t* pixels, std::uint8_t* inks) {
    if (setjmp(errors_.leave) != 0) return false;
    jpeg_.out_color_space = has_inks() ? JCS_CMYK : JCS_GRAYSCALE;
    jpeg_start_decompress(&jpeg_);
    while (jpeg_.output_scanline < jpeg_.output_height) {
      std::uint8_t* grey = pixels + static_cast<std::size_t>(jpeg_.output_scanline) * jpeg_.output_width;
      JSAMPROW row = has_inks() ? inks : grey;
      jpeg_read_scanlines(&jpeg_, &row, 1);
      if (has_inks())
        for (JDIMENSION u = 0; u < jpeg_.output_width; ++u) grey[u] = grey_of_inks(inks + std::size_t{4} * u);
    }
    jpeg_finish_decompress(&jpeg_);
    return !errors_.cut_off;
  }

  [[nodiscard]] ImageSize size() const {
    return {static_cast<int>(jpeg_.image_width), static_cast<int>(jpeg_.image_height)};
  }
  /// CMYK, or YCCK, which libjpeg turns into it.
  [[nodiscard]] bool has_inks() const {
    return jpeg_.jpeg_color_space == JCS_CMYK || jpeg_.jpeg_color_space == JCS_YCCK;
  }
  /// What is the matter with the file: that it is damaged, or of a kind that libjpeg does not read.
  [[nodiscard]] Error error(const std::string& name) const {
    constexpr std::array<int, 5> kUnknownKinds{JERR_SOF_UNSUPPORTED, JERR_BAD_PRECISION,
                                               JERR_CONVERSION_NOTIMPL, JERR_ARITH_NOTIMPL,
                                               JERR_COMPONENT_COUNT};
    if (std::ranges::find(kUnknownKinds, errors_.msg_code) == kUnknownKinds.end())
      return damaged(name, "JPEG", errors_.text);
    return {
        fmt::format("{}: a kind of JPEG that is not supported: {}; expected 8 bits, baseline or progressive",
                    name, errors_.text)};
  }

 private:
  /// All common programs store the inks as Adobe does: 255 is none of it.
  static std::uint8_t grey_of_inks(const std::uint8_t* cmyk) {
    return static_cast<std::uint8_t>((grey_of(cmyk) * cmyk[3] + 127) / 255);
  }

  std::string_view bytes_;
  JpegErrors errors_;
  jpeg_decompress_struct jpeg_{};
};

Result<GreyImage> decode_jpeg(std::string_view bytes, const std::string& name,
                              std::optional<ImageSize> expected) {
  JpegDecoder decoder(bytes);
  if (!decoder.read_header()) return decoder.error(name);
  const ImageSize size = decoder.size();
  if (auto fits = check_size(size, name, expected); !fits) return fits.error();
  GreyImage image(size.width_px, size.height_px);
  std::vector<std::uint8_t> inks(decoder.has_inks() ? 4 * static_cast<std::size_t>(size.width_px) : 0);
  if (!decoder.read_grey(image.data(), inks.data())) return decoder.error(name);
  return image;
}

/// A number of the header of a PGM file, behind blanks and comments; the file then goes on behind it.
std::optional<int> take_pgm_number(std::string_view& bytes) {
  constexpr std::string_view kBlanks = " \t\r\n";
  while (!bytes.empty() && (bytes.front() == '#' || kBlanks.find(bytes.front()) != std::string_view::npos))
    bytes.remove_prefix(bytes.front() == '#' ? std::min(bytes.find('\n'), bytes.size()) : 1);
  int number = 0;
  const auto [end, error] = std::from_chars(bytes.data(), bytes.data() + bytes.size(), number);
  if (error != std::errc{}) return std::nullopt;
  bytes.remove_prefix(static_cast<std::size_t>(end - bytes.data()));
  return number;
}

/// Grey values of one byte, or of two with the upper one first, up to `white`. Two bytes with a white of
/// 65535 may still use fewer bits.
GreyImage read_pgm_values(const std::uint8_t* bytes, ImageSize size, int white, UsedBits& bits) {
  DeepImage deep{size.width_px, size.height_px, {}};
  deep.values.resize(static_cast<std::size_t>(size.width_px) * static_cast<std::size_t>(size.height_px));
  for (auto& value : deep.values) {
    value = *bytes++;
    if (white > 255) value = static_cast<std::uint16_t>(256 * value + *bytes++);
  }
  if (white > 255 && white < 65535) bits.shift(static_cast<std::uint16_t>(white));
  if (white > 255) return to_grey(deep, bits);
  GreyImage image(size.width_px, size.height_px);
  std::ranges::transform(deep.values, image.data(), [white](int value) {
    return static_cast<std::uint8_t>((std::min(value, white) * 255 + white / 2) / white);
  });
  return image;
}

Result<GreyImage> decode_pgm(std::string_view bytes, const std::string& name,
                             std::optional<ImageSize> expected, UsedBits& bits) {
  bytes.remove_prefix(2);
  const auto width_px = take_pgm_number(bytes);
  const auto height_px = take_pgm_number(bytes);
  const auto white = take_pgm_number(bytes);
  if (!width_px || !height_px || !white)
    return damaged(name, "PGM", "width, height and maximum grey value are missing");
  if (*white < 1 || *white > 65535)
    return damaged(name, "PGM", fmt::format("the maximum grey value is {}; expected 1 to 65535", *white));
  const ImageSize size{*width_px, *height_px};
  if (auto fits = check_size(size, name, expected); !fits) return fits.error();
  const auto pixels = static_cast<std::size_t>(*width_px) * static_cast<std::size_t>(*height_px);
  if (bytes.size() < pixels * (*white > 255 ? 2 : 1) + 1) return damaged(name, "PGM", "it is cut off");
  return read_pgm_values(reinterpret_cast<const std::uint8_t*>(bytes.data()) + 1, size, *white, bits);
}

/// Formats that cameras and converters write, too, by their first bytes.
struct OtherFormat {
  std::string_view name;
  std::string_view magic;
};

constexpr std::array kOtherFormats{OtherFormat{"a TIFF", {"II*\0", 4}}, OtherFormat{"a TIFF", {"MM\0*", 4}},
                                   OtherFormat{"a WebP", "RIFF"},       OtherFormat{"a GIF", "GIF8"},
                                   OtherFormat{"a BMP", "BM"},          OtherFormat{"a PPM", "P6"},
                                   OtherFormat{"a text PGM", "P2"},     OtherFormat{"an OpenEXR", "v/1\x01"}};

std::string what_it_is(std::string_view bytes) {
  if (bytes.empty()) return "is empty";
  for (const auto& [name, magic] : kOtherFormats)
    if (bytes.starts_with(magic)) return fmt::format("is {} image", name);
  return "is not an image that can be read";
}

constexpr std::string_view kPng = "\x89PNG";
constexpr std::string_view kJpeg = "\xFF\xD8";
constexpr std::string_view kPgm = "P5";

}  // namespace

bool is_image_file(std::string_view bytes) {
  return bytes.starts_with(kPng) || bytes.starts_with(kJpeg) || bytes.starts_with(kPgm);
}

Result<GreyImage> decode_image(std::string_view bytes, const std::string& name,
                               std::optional<ImageSize> expected) {
  UsedBits bits;
  return decode_image(bytes, name, expected, bits);
}

Result<GreyImage> decode_image(std::string_view bytes, const std::string& name,
                               std::optional<ImageSize> expected, UsedBits& bits) {
  if (bytes.starts_with(kPng)) return decode_png(bytes, name, expected, bits);
  if (bytes.starts_with(kJpeg)) return decode_jpeg(bytes, name, expected);
  if (bytes.starts_with(kPgm)) return decode_pgm(bytes, name, expected, bits);
  return Error{fmt::format("{}: {}; expected a PNG, JPEG or PGM image", name, what_it_is(bytes))};
}

Result<GreyImage> read_image(const std::filesystem::path& path, std::optional<ImageSize> expected) {
  UsedBits bits;
  return read_image(path, expected, bits);
}

Result<GreyImage> read_image(const std::filesystem::path& path, std::optional<ImageSize> expected,
                             UsedBits& bits) {
  const auto bytes = read_file(path);
  if (!bytes) return bytes.error();
  return decode_image(*bytes, path.string(), expected, bits);
}

Result<std::string> encode_png(const ImageView& image) {
  PngImage png;
  png.width = static_cast<png_uint_32>(image.width_px);
  png.height = static_cast<png_uint_32>(image.height_px);
  png.format = PNG_FORMAT_GRAY;
  std::string bytes(PNG_IMAGE_PNG_SIZE_MAX(png), '\0');
  png_alloc_size_t size = bytes.size();
  const auto stride = static_cast<png_int_32>(image.stride);
  if (png_image_write_to_memory(&png, bytes.data(), &size, 0, image.data, stride, nullptr) == 0)
    return Error{fmt::format("cannot write a PNG image: {}", png.message), Error::Kind::kFailed};
  bytes.resize(size);
  return bytes;
}

Result<void> write_png(const std::filesystem::path& path, const ImageView& image) {
  const auto bytes = encode_png(image);
  if (!bytes) return Error{fmt::format("{}: {}", path.string(), bytes.error().message), bytes.error().kind};
  return write_file(path, *bytes);
}

}  // namespace waymark
