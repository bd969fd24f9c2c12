#pragma once

#include <vector>

#include "waymark/ekf/pixel_map.hpp"
#include "waymark/ekf/pixel_prediction.hpp"
#include "waymark/ekf/pixel_slam_options.hpp"

namespace waymark::ekf {

/// One exact update of the state with some pixels, linearised anew where it leads as long as that matters
/// (Bell and Cathey 1993): a ray of unsure depth that is seen from elsewhere. Not with first estimates, which
/// stay what they are, and not in the modes that are the article's, which linearises once. Takes its memory
/// once.
class IteratedPixelUpdate {
 public:
  /// The prediction must outlive it.
  IteratedPixelUpdate(const PixelSlamOptions& options, const PixelPrediction& prediction);

  void clear();
  /// A pixel, and how it is linearised at the present estimate. At most State::kMaxObservations.
  void add(const FoundPixel& found, const LinearizedObservation& linearization);
  /// Updates the state with all of them. False, and nothing changed, if S is not positive definite.
  [[nodiscard]] bool apply(PixelMap& map);

 private:
  [[nodiscard]] bool relinearize(const PixelMap& map);

  const PixelPrediction& prediction_;
  int max_iterations_;
  std::vector<FoundPixel> found_;
  std::vector<LinearizedObservation> linearizations_;
  std::vector<LinearizedObservation> refined_;  ///< linearised where the update leads
};

}  // namespace waymark::ekf
