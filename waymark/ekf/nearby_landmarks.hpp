#pragma once

#include <vector>

#include <Eigen/Core>

#include "waymark/association/grid_index.hpp"
#include "waymark/core/as_index.hpp"
#include "waymark/ekf/point_map.hpp"

namespace waymark::ekf {

/// The landmarks of a map by where they are, to find those that an observation may be of. Places are in the
/// world, those of refresh(); landmarks are named by their index then. Memory is taken as the map grows and
/// kept.
class NearbyLandmarks {
 public:
  explicit NearbyLandmarks(double sensor_range_m);

  /// Takes in where the landmarks are now. Where one outside of the submap of a compressed map is takes a
  /// while to find out: those out of the sensor's reach are asked every 16th scan. O(n).
  void refresh(PointMap& map, const Eigen::Vector2d& p_world_sensor);

  /// Calls visit(landmark) for those within `radius_m` of a point.
  template <class Visit>
  void visit(const Eigen::Vector2d& p_world, double radius_m, const Visit& visit) const {
    grid_.visit_near(p_world, radius_m, visit);
  }
  [[nodiscard]] const Eigen::Vector2d& place(int landmark) const { return places_[as_index(landmark)]; }
  /// The largest standard deviation of a landmark when it was last seen.
  [[nodiscard]] double sigma_m() const { return sigma_m_; }

 private:
  double sensor_range_m_;
  GridIndex grid_;
  std::vector<Eigen::Vector2d> places_;
  double sigma_m_ = 0.0;
};

}  // namespace waymark::ekf
