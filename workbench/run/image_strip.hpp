#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "waymark/core/filter.hpp"
#include "waymark/core/grey_image.hpp"
#include "waymark/core/stamp.hpp"
#include "waymark/vision/search_record.hpp"

namespace waymark {

/// An image and what became of everything that was looked for in it.
struct StripFrame {
  Stamp stamp;
  GreyImage image;
  std::vector<vision::SearchRecord> search_records;
  std::vector<LandmarkId> refused;  ///< found, and not believed by the filter
};

/// Images spread evenly over a run of unknown length: whenever there are too many of them every second one
/// goes, and from then on half as many are kept.
class ImageStrip {
 public:
  explicit ImageStrip(std::size_t most = 24) : most_(most) {}

  /// Called with every image; copies those that it keeps.
  void add(Stamp stamp, const GreyImage& image, std::span<const vision::SearchRecord> search_records,
           std::span<const Innovation> innovations);

  [[nodiscard]] const std::vector<StripFrame>& frames() const { return frames_; }

 private:
  std::size_t most_;
  std::int64_t seen_ = 0;
  std::int64_t every_ = 1;
  std::vector<StripFrame> frames_;
};

}  // namespace waymark
