#pragma once

#include <Eigen/Geometry>

#include "waymark/core/random.hpp"
#include "waymark/models/camera.hpp"

namespace waymark::test {

/// A camera with a lens of moderate distortion, anywhere on the robot, looking anywhere but straight up or
/// down.
inline CameraOptions random_camera(RandomStream& random) {
  CameraOptions o;
  o.fu_px = random.uniform(260.0, 400.0);
  o.fv_px = o.fu_px * random.uniform(0.9, 1.1);
  o.cu_px += random.uniform(-10.0, 10.0);
  o.cv_px += random.uniform(-10.0, 10.0);
  o.distortion = {random.uniform(-0.2, 0.1), random.uniform(0.0, 0.1), random.uniform(-0.005, 0.005),
                  random.uniform(-0.005, 0.005), random.uniform(-0.01, 0.01)};
  o.mount = {random.uniform(-0.5, 0.5),   random.uniform(-0.5, 0.5),   random.uniform(0.1, 2.0),
             random.uniform(-45.0, 45.0), random.uniform(-45.0, 45.0), random.uniform(-180.0, 180.0)};
  return o;
}

inline Eigen::Vector2d random_pixel(const Camera& camera, RandomStream& random) {
  return {random.uniform(0.0, camera.width_px() - 1.0), random.uniform(0.0, camera.height_px() - 1.0)};
}

}  // namespace waymark::test
