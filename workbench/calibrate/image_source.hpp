#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "waymark/core/grey_image.hpp"
#include "waymark/core/result.hpp"

#include "workbench/run/open_source.hpp"

namespace waymark::calibrate {

/// An image, or why it cannot be read.
struct NamedImage {
  std::string name;
  Result<GreyImage> pixels;
};

/// Images one after the other.
class ImageSource {
 public:
  ImageSource() = default;
  ImageSource(const ImageSource&) = delete;
  ImageSource& operator=(const ImageSource&) = delete;
  virtual ~ImageSource() = default;

  /// Nothing at the end; an error where it cannot go on.
  [[nodiscard]] virtual Result<std::optional<NamedImage>> next() = 0;

  /// Fraction of them that has been read.
  [[nodiscard]] virtual double progress() const = 0;

  /// Do they follow each other in time, as frames do, so that neighbours look alike?
  [[nodiscard]] virtual bool is_stream() const = 0;
};

/// More frames than these of a stream are passed over: a hand moves no faster.
inline constexpr double kFramesPerSecond = 5.0;

/// The images that the inputs name: image files, patterns of them ("left*.jpg"), folders of them; or one
/// log folder or bag with images; or one video. Errors say what was expected.
[[nodiscard]] Result<std::unique_ptr<ImageSource>> open_images(const std::vector<std::string>& inputs,
                                                               const InputOptions& options = {});

}  // namespace waymark::calibrate
