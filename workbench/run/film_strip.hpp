#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "waymark/core/filter.hpp"
#include "waymark/core/grey_image.hpp"
#include "waymark/core/stamp.hpp"
#include "waymark/vision/look.hpp"

namespace waymark {

/// A picture and what became of everything that was looked for in it.
struct FilmFrame {
  Stamp stamp;
  GreyImage picture;
  std::vector<vision::Look> looks;
  std::vector<LandmarkId> refused;  ///< found, and not believed by the filter
};

/// Pictures spread evenly over a run of unknown length: whenever there are too many of them every second one
/// goes, and from then on half as many are kept.
class FilmStrip {
 public:
  explicit FilmStrip(std::size_t most = 24) : most_(most) {}

  /// Called with every picture; copies those that it keeps.
  void add(Stamp stamp, const GreyImage& picture, std::span<const vision::Look> looks,
           std::span<const Innovation> innovations);

  [[nodiscard]] const std::vector<FilmFrame>& frames() const { return frames_; }

 private:
  std::size_t most_;
  std::int64_t seen_ = 0;
  std::int64_t every_ = 1;
  std::vector<FilmFrame> frames_;
};

}  // namespace waymark
