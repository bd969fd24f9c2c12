#pragma once

#include <Eigen/Core>

#include "waymark/core/event.hpp"
#include "waymark/core/random.hpp"
#include "waymark/models/odometry.hpp"

#include "workbench/sim/options.hpp"

namespace waymark::sim {

/// What the encoders count while the wheels roll `command`: the travel of each wheel with an error of its own
/// whose variance grows with the travel (Chong and Kleeman 1997). Two normals.
[[nodiscard]] WheelAngles encoder_increment(const WheelOptions& wheels, const ArcStep& command,
                                            RandomStream& random);

/// How far the robot slips while the wheels roll `command`: (x, y, theta) in the frame before. Slip in
/// distance and turn goes the way of the arc, to first order, and slip sideways across its chord. Three
/// normals.
[[nodiscard]] Eigen::Vector3d draw_slip(const WheelOptions& wheels, const ArcStep& command,
                                        RandomStream& random);

/// The geometry of the wheels, as a filter needs it to undo the encoders.
[[nodiscard]] WheelGeometry geometry(const WheelOptions& wheels);

/// The noise that a filter should assume. With velocities or poses a filter sees no wheels, so their errors
/// are counted as forward and turning errors: exact on straight lines and for the heading of turns on the
/// spot.
[[nodiscard]] OdometryNoise assumed_noise(const WheelOptions& wheels);

}  // namespace waymark::sim
