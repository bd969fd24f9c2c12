#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "waymark/core/grey_image.hpp"
#include "waymark/core/result.hpp"

#include "workbench/logs/used_bits.hpp"

namespace waymark {

struct ImageSize {
  int width_px = 0;
  int height_px = 0;

  friend bool operator==(const ImageSize&, const ImageSize&) = default;
};

/// Larger ones are taken for damage.
inline constexpr int kMaxImageSide_px = 16384;

/// Do the bytes begin as those of a file that decode_image() reads?
[[nodiscard]] bool is_image_file(std::string_view bytes);

/// A PNG, JPEG (also CMYK) or PGM file (binary), told by its first bytes, as grey = 0.299 R + 0.587 G + 0.114
/// B. Transparent parts lie on black. Values of 16 bits are scaled by the bits that the image uses. Damaged
/// and cut-off files, and those of another size than `expected`, are errors.
[[nodiscard]] Result<GreyImage> read_image(const std::filesystem::path& path,
                                           std::optional<ImageSize> expected = {});
/// One of a sequence that shares its `bits`.
[[nodiscard]] Result<GreyImage> read_image(const std::filesystem::path& path,
                                           std::optional<ImageSize> expected, UsedBits& bits);
/// The same from memory, as camera messages in bags have them; `name` stands for the file in errors.
[[nodiscard]] Result<GreyImage> decode_image(std::string_view bytes, const std::string& name,
                                             std::optional<ImageSize> expected = {});
[[nodiscard]] Result<GreyImage> decode_image(std::string_view bytes, const std::string& name,
                                             std::optional<ImageSize> expected, UsedBits& bits);

/// The bytes of a grey PNG file.
[[nodiscard]] Result<std::string> encode_png(const ImageView& image);
/// As a grey PNG file.
[[nodiscard]] Result<void> write_png(const std::filesystem::path& path, const ImageView& image);

}  // namespace waymark
