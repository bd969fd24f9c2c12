#include "workbench/logs/image_loader.hpp"

#include <algorithm>
#include <ranges>
#include <utility>

#include <fmt/format.h>

#include "workbench/logs/text_lines.hpp"

namespace waymark {
namespace {

/// The last value of a key, 0 if there is none.
int setting_px(const LogInfo& info, std::string_view key) {
  for (const auto& [name, value] : info.settings | std::views::reverse)
    if (name == key) return parse_integer(value).value_or(0);
  return 0;
}

std::optional<ImageSize> camera_size(const LogInfo& info) {
  const ImageSize size{setting_px(info, "camera.width_px"), setting_px(info, "camera.height_px")};
  return size.width_px > 0 && size.height_px > 0 ? std::optional(size) : std::nullopt;
}

}  // namespace

ImageLoader::ImageLoader(std::unique_ptr<Source> source)
    : source_(std::move(source)), expected_(camera_size(source_->info())) {}

Result<std::optional<Event>> ImageLoader::next() {
  while (true) {
    auto event = source_->next();
    if (!event || !*event) return event;
    auto* image = std::get_if<Image>(&(**event).content);
    if (image == nullptr || load(*image)) return event;
  }
}

bool ImageLoader::load(Image& image) {
  if (image.pixels != nullptr) return true;
  auto pixels = image.encoded ? decode_image(*image.encoded, image.file, expected_, bits_)
                              : read_image(image.file, expected_, bits_);
  image.encoded.reset();
  if (pixels) {
    image.pixels = std::make_shared<const GreyImage>(*std::move(pixels));
    return true;
  }
  if (skipped_++ == 0) first_reason_ = pixels.error().message;
  return false;
}

std::vector<std::string> ImageLoader::notes() const {
  std::vector<std::string> all = source_->notes();
  if (const std::string bits = bits_.note(); !bits.empty())
    all.push_back(fmt::format("images: the camera {}; their grey values are scaled accordingly", bits));
  if (skipped_ > 0)
    all.push_back(fmt::format("images skipped: {}, the first because: {}", skipped_, first_reason_));
  return all;
}

}  // namespace waymark
