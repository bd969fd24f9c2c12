#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "waymark/core/filter.hpp"
#include "waymark/core/observation.hpp"
#include "waymark/ekf/locate.hpp"
#include "waymark/ekf/point_map.hpp"
#include "waymark/ekf/point_observation.hpp"

namespace waymark::ekf {

/// Deferred initialisation of landmarks of which only ranges, or only bearings, are observed. Such a landmark
/// is not in the state before several views of it leave one position for it; then all of them correct it at
/// once, each with the place that it was seen from, which is a point of the state meanwhile, or two where the
/// direction counts. Each view is used once. docs/ekf.md, "Ranges alone, bearings alone", has the formulas.
class DeferredInitialiser {
 public:
  /// Bound to the map that it adds landmarks to and to the sensor's model.
  DeferredInitialiser(PointMap& map, const PointObservation& sensor, Consistency consistency);

  /// The views that follow are from the robot's present pose.
  void begin_scan() { here_ = -1; }

  /// Takes a range or a bearing of a landmark that is not in the map, after the update of its scan. kAdded if
  /// the landmark now is, else kDeferred. Keeps 12 views of a landmark and 64 viewpoints at most. Allocates;
  /// a view costs O(n), trying to locate a landmark of m views a handful of O(m^3) steps.
  [[nodiscard]] Outcome observe(LandmarkId id, const Observation& observation);

 private:
  /// A place where the sensor was: handles of its points, and how many views hang on it.
  struct Viewpoint {
    int place = -1;
    int ahead = -1;  ///< a metre ahead of it; -1 where no direction was measured
    int users = 0;
  };

  /// Indices of the same points in the state, which change.
  struct Points {
    int place;
    int ahead;
  };

  /// A range or a bearing that is kept.
  struct PartialView {
    int viewpoint;
    Measurement value;
    double variance;
  };

  /// A landmark of which too little is known to have it in the state.
  struct Unlocated {
    LandmarkId id;
    std::vector<PartialView> views = {};
    double observed_at_m = 0.0;
    double spacing_m;
  };

  [[nodiscard]] int viewpoint_here(bool with_direction);
  void release(int viewpoint);
  void thin(Unlocated& unlocated);
  [[nodiscard]] Points points_of(const PartialView& view) const;
  template <class Here, class At>
  [[nodiscard]] std::optional<LinearizedObservation> linearize_partial(const PartialView& view,
                                                                       const Eigen::Vector2d& p_world,
                                                                       const Here& here, const At& at) const;
  [[nodiscard]] std::optional<LinearizedViews> views_at(const Unlocated& unlocated,
                                                        const Eigen::Vector2d& p_world) const;
  void consider_views(const Unlocated& unlocated, int landmark);
  [[nodiscard]] bool locate(const Unlocated& unlocated);
  [[nodiscard]] bool initialise(const Unlocated& unlocated, const Eigen::Vector2d& p_world,
                                double anywhere_m);
  [[nodiscard]] bool gather_views(const Unlocated& unlocated, int landmark, bool at_proposal);

  PointMap& map_;
  const PointObservation& sensor_;
  int iterations_;
  std::vector<Viewpoint> viewpoints_;
  std::vector<Unlocated> unlocated_;
  int here_ = -1;  // viewpoint of the present scan
  std::vector<LinearizedObservation> block_;
};

}  // namespace waymark::ekf
