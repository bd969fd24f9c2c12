#pragma once

#include <cstddef>
#include <vector>

#include "waymark/core/observation.hpp"
#include "waymark/fastslam/belief.hpp"
#include "waymark/fastslam/fast_slam_options.hpp"
#include "waymark/fastslam/landmark_forms.hpp"
#include "waymark/fastslam/particle_matcher.hpp"
#include "waymark/fastslam/scan.hpp"
#include "waymark/fastslam/sensor_model.hpp"
#include "waymark/fastslam/view_history.hpp"

namespace waymark::fastslam {

/// Map management: initialises landmarks, drops their hypotheses as observations decide, and deletes false
/// tracks.
class MapManagement {
 public:
  MapManagement(const FastSlamOptions& options, const SensorModel& model);

  /// How many more landmarks the map can hold.
  [[nodiscard]] int room(const Belief& belief) const { return capacity_ - belief.store.size(); }

  /// Initialises the landmark of an observation that is new (Outcome::kAdded) to all particles, and names it
  /// where the observation does not. O(N).
  void initialise(std::size_t index, Scan& scan, const ViewHistory& history, Belief& belief);
  /// Initialises what is new to those particles only that chose so. Keeps room for the observations that are
  /// new to all particles; what then has no room becomes Outcome::kMapFull.
  void initialise_choices(Scan& scan, const ParticleMatcher& matcher, Belief& belief);

  /// Hypotheses that were expected in this scan, of landmarks that were not seen, become less likely.
  void miss(Belief& belief) const;
  /// Landmarks may have become simpler: fewer hypotheses, or points.
  void refine(Belief& belief);

  /// Forgets one landmark; the last one takes its index.
  void forget(int landmark, Belief& belief);
  /// Forgets landmarks that no particle believes in any more, and those that a single observation left
  /// behind. O(landmarks).
  void delete_false_tracks(Belief& belief);

 private:
  void initialise_named(const Observation& observation, const ViewHistory& history, Belief& belief);
  [[nodiscard]] LandmarkId initialise_without_identity(const Observation& observation, Belief& belief);
  [[nodiscard]] kernels::LandmarkMeasurement seen_first(const Observation& observation,
                                                        const Belief& belief) const;
  void place(int landmark, const kernels::LandmarkMeasurement& seen, const kernels::FirstGuess& guess,
             Belief& belief) const;

  SensorModel model_;
  int capacity_;
  std::vector<int> unresolved_;  // rays and rings
};

}  // namespace waymark::fastslam
