#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "waymark/core/expectation.hpp"
#include "waymark/core/filter.hpp"
#include "waymark/ekf/bounded_map.hpp"
#include "waymark/ekf/candidate.hpp"
#include "waymark/ekf/pixel_prediction.hpp"
#include "waymark/ekf/pixel_slam_options.hpp"

namespace waymark::ekf {

/// Delayed initialisation of landmarks whose depth one pixel does not tell (Davison 2003; the initialisation
/// part of algorithm 1 in Vincke et al. 2012): what is new begins as a candidate on an anchor that all
/// candidates of one image share, later pixels weigh the particles of its depth, and once they know it the
/// candidate becomes a landmark of the map, as a ray or as a point. Owns the candidates. Takes its memory
/// once.
class DepthInitialiser {
 public:
  /// Images in which a candidate is found before it becomes a landmark; with unknown depth.
  static constexpr int kMinImages = 8;
  static constexpr int kMaxImages = 15;

  /// The map and the prediction must outlive it.
  DepthInitialiser(const PixelSlamOptions& options, BoundedMap& map, const PixelPrediction& prediction);

  /// What begins from now on stands on a new anchor. Candidates that take too long, or were not found in more
  /// than half of at least ten attempts, are given up.
  void begin_image();
  /// The candidates that should be in the image. Valid until the next call of this.
  [[nodiscard]] std::span<const Expectation> expect();

  /// How many candidates there are.
  [[nodiscard]] int size() const;
  [[nodiscard]] bool knows(LandmarkId id) const { return find(id) < candidates_.size(); }
  /// A landmark was looked for and not found; does nothing where it is no candidate.
  void missed(LandmarkId id);

  /// A candidate was found in a pixel of noise R, px^2: weighs its depths with it. False, and the depths stay
  /// what they were, where it is outside of the gate of all of them. O(particles).
  [[nodiscard]] bool weigh(LandmarkId id, const Eigen::Vector2d& z_px, const Eigen::Matrix2d& R);
  /// Whether a candidate is to become a landmark: its depth is known well enough, or is taking too long to
  /// show.
  [[nodiscard]] bool is_ready(LandmarkId id) const;
  /// A candidate becomes a landmark, whose index in the map this is; nothing, and it is given up, where the
  /// map has no room. O(n) for a state of n values.
  ///
  /// Its particles took the errors of the robot's way since the anchor for new ones in every image, while
  /// they are nearly the same in all of them: they are too sure, and know nothing of what the depth has in
  /// common with the pose. A ray is therefore added with its depth less sure than they say. The caller lets
  /// the state learn the depth anew from the pixel that was last weighed: the state holds the poses of this
  /// and of the first one. The particles say where to linearise.
  [[nodiscard]] std::optional<int> accept(LandmarkId id);

  /// Something new was seen in a pixel of noise R, px^2: kAdded as a candidate, or kMapFull where there
  /// is no room.
  [[nodiscard]] Outcome begin(LandmarkId id, const Eigen::Vector2d& z_px, const Eigen::Matrix2d& R);

 private:
  [[nodiscard]] std::size_t find(LandmarkId id) const;
  void give_up(Candidate& candidate);
  [[nodiscard]] Eigen::Matrix2d jitter_of(const PixelRay& ray) const;

  PixelSlamOptions options_;
  BoundedMap& map_;
  const PixelPrediction& prediction_;
  double gate_;  ///< of the NIS of a pixel
  std::vector<Candidate> candidates_;
  std::optional<int> anchor_;  ///< of what begins in this image
  std::vector<Expectation> expectations_;
};

}  // namespace waymark::ekf
