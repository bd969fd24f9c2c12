#pragma once

#include <memory>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "waymark/core/event.hpp"
#include "waymark/core/filter.hpp"
#include "waymark/core/function_blocks.hpp"
#include "waymark/core/grey_image.hpp"
#include "waymark/core/map_state.hpp"
#include "waymark/vision/search_record.hpp"
#include "waymark/vision/tracker_counts.hpp"

namespace waymark {

/// Interface of what finds observations in images for a filter. The pipeline announces each image that
/// fits as soon as it arrives; when the filter has reached its stamp, it requests the observations or
/// drops the image.
class FrontEnd {
 public:
  using SharedImage = std::shared_ptr<const GreyImage>;

  /// What was seen: observations for the filter, which join those of other sensors of the same stamp; or what
  /// the filter made of it where the front end corrects the filter itself. Valid until the next call.
  using Seen = std::variant<std::span<const Observation>, const Correction*>;

  FrontEnd() = default;
  FrontEnd(const FrontEnd&) = delete;
  FrontEnd& operator=(const FrontEnd&) = delete;
  virtual ~FrontEnd() = default;

  /// Has it the size of the camera's images?
  [[nodiscard]] virtual bool fits(const ImageView& image) const = 0;
  /// Does see() correct the filter? Then observations that come with an image go before it.
  [[nodiscard]] virtual bool corrects_filter() const = 0;
  /// Does it take what another program found in an image?
  [[nodiscard]] virtual bool takes_outlines() const { return false; }

  /// An image that will be seen or dropped: it may be looked into from now on.
  virtual void announce(const SharedImage& /*image*/) {}
  virtual void drop(const SharedImage& /*image*/) {}

  /// Looks into an image that fits, taken at the pose that the filter has reached.
  virtual Seen see(const SharedImage& image) = 0;
  /// The observations where another program has looked. Valid until the next call.
  virtual std::span<const Observation> see(const MarkerOutlines& /*outlines*/) { return {}; }

  /// Times of its own function blocks.
  [[nodiscard]] virtual std::span<const FunctionBlocks::Row> blocks() const = 0;
  /// What was not used and why, and what looks wrong in view of what the filter made of it; one line each.
  [[nodiscard]] virtual std::vector<std::string> notes(std::span<const Innovation> innovations) const = 0;

  /// What became of everything that was searched for in the last image, where it searches.
  [[nodiscard]] virtual std::span<const vision::SearchRecord> search_records() const { return {}; }
  /// What landmarks look like, where it remembers that. Allocates.
  [[nodiscard]] virtual std::vector<LandmarkPatch> patches() const { return {}; }
  [[nodiscard]] virtual vision::TrackerCounts tracker_counts() const { return {}; }
};

}  // namespace waymark
