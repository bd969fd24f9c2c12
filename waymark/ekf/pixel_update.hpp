#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "waymark/core/filter.hpp"
#include "waymark/ekf/bounded_map.hpp"
#include "waymark/ekf/consensus.hpp"
#include "waymark/ekf/iterated_update.hpp"
#include "waymark/ekf/pixel_prediction.hpp"
#include "waymark/ekf/pixel_slam_options.hpp"

namespace waymark::ekf {

/// The update of the state with the pixels in which landmarks were found, in blocks of at most
/// State::kMaxSightings, each linearised at what the earlier ones found: first those of a block that agree
/// (Consensus), then those that fit where these have led. Both are linearised anew where they lead, as a ray
/// of unsure depth needs it that is seen from elsewhere, but not in the modes that are the article's. With
/// UpdateMethod::kTextbook each is gated by itself, as in the article. Takes its memory once.
class PixelUpdate {
 public:
  /// The map and the prediction must outlive it. Has the state update itself as the options say.
  PixelUpdate(const PixelSlamOptions& options, BoundedMap& map, const PixelPrediction& prediction);

  /// One innovation per pixel, which says what became of it; a landmark may be there once. The map notes who
  /// matched and who was gated. Valid until the next call. Costs per block are those of State::update(), the
  /// correction of P once and the rest as often as it is linearised.
  [[nodiscard]] std::span<const Innovation> update(std::span<const FoundPixel> found);
  /// Updates the state with one pixel whoever agrees. Nothing where it cannot be used.
  [[nodiscard]] std::optional<Innovation> confirm(const FoundPixel& found);

 private:
  /// A pixel at the present estimate.
  struct Compared {
    Sighting sighting;
    Eigen::Matrix2d S;
    double nis;
  };

  [[nodiscard]] std::optional<Compared> compare(const FoundPixel& found, const CameraPose& here) const;
  [[nodiscard]] Innovation innovation(const FoundPixel& found, const Compared& compared) const;
  [[nodiscard]] std::size_t collect(std::span<const FoundPixel> found, std::size_t first);
  void judge();
  void update_matched(std::span<const FoundPixel> found);
  void rescue(std::span<const FoundPixel> found);
  void update_used(std::span<const FoundPixel> found);
  [[nodiscard]] bool apply(std::span<const FoundPixel> found);
  void note_usefulness(std::span<const FoundPixel> found);

  BoundedMap& map_;
  const PixelPrediction& prediction_;
  double gate_;       ///< of the NIS of a pixel
  bool gates_alone_;  ///< each by itself
  Consensus consensus_;
  IteratedUpdate update_;
  std::vector<Innovation> innovations_;

  // One per sighting of the block:
  std::vector<std::size_t> block_;  ///< which pixel it is
  std::vector<Sighting> sightings_;
  std::vector<Eigen::Vector2d> nus_;
  std::vector<PoseSighting> told_;  ///< what it told about the pose

  // One per sighting of the update:
  std::vector<std::size_t> used_;  ///< which pixel it is
  std::vector<Sighting> used_sightings_;
};

}  // namespace waymark::ekf
