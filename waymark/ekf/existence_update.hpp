#pragma once

#include "waymark/association/association_options.hpp"
#include "waymark/ekf/nearby_landmarks.hpp"
#include "waymark/ekf/point_map.hpp"
#include "waymark/ekf/point_observation.hpp"
#include "waymark/models/landmark_sensor.hpp"

namespace waymark::ekf {

/// Judges the landmarks by one scan, after its update: those that were observed are surer, those that are not
/// certain and in view of `sensor` by three standard deviations of what would be measured, but were not
/// observed, are less so (Existence). `nearby` is of the present estimate. O(n), and an innovation covariance
/// for each that was missed.
void update_existence(PointMap& map, const NearbyLandmarks& nearby, const PointObservation& observation,
                      const AssociationModel& model, const LandmarkSensor& sensor);

/// Removes the landmarks that were missed too often and those that a single observation left behind.
void remove_false_tracks(PointMap& map);

}  // namespace waymark::ekf
