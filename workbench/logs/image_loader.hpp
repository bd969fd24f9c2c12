#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "workbench/logs/image_file.hpp"
#include "workbench/logs/source.hpp"

namespace waymark {

/// A log whose images are read, or unpacked, when their turn comes, one at a time: gives each image event its
/// pixels. Images of 16 bits a sample are scaled by the bits that the camera uses (UsedBits), and a note says
/// so.
/// Images that cannot be read and those of another size than the camera's are skipped and counted.
class ImageLoader final : public Source {
 public:
  /// The size that images must have is that of the log's camera, where the log knows one.
  explicit ImageLoader(std::unique_ptr<Source> source);

  [[nodiscard]] const LogInfo& info() const override { return source_->info(); }
  [[nodiscard]] Result<std::optional<Event>> next() override;
  [[nodiscard]] std::vector<std::string> notes() const override;
  [[nodiscard]] double progress() const override { return source_->progress(); }
  [[nodiscard]] std::optional<Replay> replay() const override { return source_->replay(); }

 private:
  [[nodiscard]] bool load(Image& image);

  std::unique_ptr<Source> source_;
  std::optional<ImageSize> expected_;
  UsedBits bits_;
  int skipped_ = 0;
  std::string first_reason_;
};

}  // namespace waymark
