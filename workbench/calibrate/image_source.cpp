#include "workbench/calibrate/image_source.hpp"

#include <algorithm>
#include <array>
#include <cctype>

#include <fmt/format.h>
#include <glob.h>

#include "workbench/bags/open_bag.hpp"
#include "workbench/calibrate/video.hpp"
#include "workbench/logs/image_file.hpp"
#include "workbench/logs/image_loader.hpp"
#include "workbench/logs/log_folder.hpp"

namespace waymark::calibrate {
namespace {

namespace fs = std::filesystem;

bool is_image_name(const fs::path& path) {
  std::string extension = path.extension().string();
  std::ranges::transform(extension, extension.begin(), [](char c) {
    return static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  });
  constexpr std::array kExtensions{".png", ".jpg", ".jpeg", ".pgm"};
  return std::ranges::find(kExtensions, extension) != kExtensions.end();
}

class ImageFiles final : public ImageSource {
 public:
  explicit ImageFiles(std::vector<fs::path> files) : files_(std::move(files)) {}

  Result<std::optional<NamedImage>> next() override {
    if (next_ == files_.size()) return std::optional<NamedImage>{};
    const fs::path& file = files_[next_++];
    return std::optional(NamedImage{file.filename().string(), read_image(file)});
  }
  [[nodiscard]] double progress() const override {
    return static_cast<double>(next_) / static_cast<double>(files_.size());
  }
  [[nodiscard]] bool is_stream() const override { return false; }

 private:
  std::vector<fs::path> files_;
  std::size_t next_ = 0;
};

class LogImages final : public ImageSource {
 public:
  explicit LogImages(std::unique_ptr<Source> source) : source_(std::move(source)) {}

  Result<std::optional<NamedImage>> next() override {
    while (true) {
      auto event = source_.next();
      if (!event) return event.error();
      if (!*event) return std::optional<NamedImage>{};
      const auto& [stamp, stream, content] = **event;
      const auto* image = std::get_if<Image>(&content);
      if (image == nullptr || (last_ && to_seconds(stamp - *last_) < 1.0 / kFramesPerSecond)) continue;
      last_ = stamp;
      return std::optional(NamedImage{fmt::format("{} s", to_string(stamp)), *image->pixels});
    }
  }
  [[nodiscard]] double progress() const override { return source_.progress(); }
  [[nodiscard]] bool is_stream() const override { return true; }

 private:
  ImageLoader source_;
  std::optional<Stamp> last_;
};

std::vector<fs::path> images_in(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code failed;
  for (const auto& entry : fs::directory_iterator(folder, failed))
    if (is_image_name(entry.path())) files.push_back(entry.path());
  std::ranges::sort(files);
  return files;
}

std::vector<fs::path> matches(const std::string& pattern) {
  std::vector<fs::path> files;
  glob_t found{};
  if (glob(pattern.c_str(), 0, nullptr, &found) == 0)
    files.assign(found.gl_pathv, found.gl_pathv + found.gl_pathc);
  globfree(&found);
  return files;
}

Result<std::vector<fs::path>> list_images(const std::string& input) {
  if (fs::is_directory(input)) {
    auto files = images_in(input);
    if (!files.empty()) return files;
    return Error{
        input + ": no images in this folder; expected .png, .jpg or .pgm files, a log with images, or a bag"};
  }
  if (fs::exists(input)) {
    if (is_image_name(input)) return std::vector<fs::path>{input};
    return Error{input +
                 " is not an image (.png, .jpg or .pgm); a video, a bag or a log must be the only input"};
  }
  auto files = matches(input);
  std::erase_if(files, [](const fs::path& file) { return !is_image_name(file); });
  if (files.empty())
    return Error{input +
                 ": there is no such file, and no image matches this pattern; expected images, a folder of "
                 "them, a video, a bag or a log with images"};
  return files;
}

bool is_log(const fs::path& path) {
  return bag::is_bag(path) || (fs::is_directory(path) && is_log_folder(path));
}

}  // namespace

Result<std::unique_ptr<ImageSource>> open_images(const std::vector<std::string>& inputs,
                                                 const InputOptions& options) {
  if (inputs.size() == 1 && is_log(inputs[0])) {
    auto source = open_source(inputs[0], options);
    if (!source) return source.error();
    return std::unique_ptr<ImageSource>(std::make_unique<LogImages>(*std::move(source)));
  }
  if (inputs.size() == 1 && fs::is_regular_file(inputs[0]) && !is_image_name(inputs[0]))
    return open_video(inputs[0]);
  std::vector<fs::path> files;
  for (const std::string& input : inputs) {
    auto more = list_images(input);
    if (!more) return more.error();
    files.insert(files.end(), more->begin(), more->end());
  }
  return std::unique_ptr<ImageSource>(std::make_unique<ImageFiles>(std::move(files)));
}

}  // namespace waymark::calibrate
