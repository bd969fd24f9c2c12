#include "workbench/config/robot_keys.hpp"

namespace waymark {

void describe(Schema& schema, OdometryOptions& o) {
  schema.real("wheels.left_radius_m", o.wheels.left_radius_m, {0.0, 10.0},
              "radius of the left wheel, m; the log's unless set", Shown::kAlways);
  schema.real("wheels.right_radius_m", o.wheels.right_radius_m, {0.0, 10.0},
              "radius of the right wheel, m; the log's unless set", Shown::kAlways);
  schema.real("wheels.track_m", o.wheels.track_m, {0.0, 100.0},
              "distance between the wheels, m; the log's unless set", Shown::kAlways);
  schema.real("car.wheel_base_m", o.car.wheel_base_m, {0.0, 100.0},
              "distance between rear and front axle of a steered car, m; its origin is the middle of the "
              "rear axle; the log's unless set");
  schema.real(
      "car.encoder_offset_m", o.car.encoder_offset_m, {-10.0, 10.0},
      "offset of the rear wheel with the encoder from the middle of a steered car, m, positive to the left");
  schema.real("motion.wheel_var_m2_per_m", o.noise.wheel_var_m2_per_m, {0.0, 1.0},
              "variance of the distance that each wheel rolls, m^2 per metre rolled", Shown::kAlways);
  schema.real("motion.forward_var_m2_per_m", o.noise.forward_var_m2_per_m, {0.0, 1.0},
              "variance of slip along the path, m^2 per metre driven");
  schema.real("motion.lateral_var_m2_per_m", o.noise.lateral_var_m2_per_m, {0.0, 1.0},
              "variance of sideways slip, m^2 per metre driven");
  schema.real("motion.turn_var_rad2_per_rad", o.noise.turn_var_rad2_per_rad, {0.0, 10.0},
              "variance of the heading, rad^2 per radian turned", Shown::kAlways);
  schema.real("motion.turn_var_rad2_per_m", o.noise.turn_var_rad2_per_m, {0.0, 10.0},
              "variance of the heading, rad^2 per metre driven");
  schema.real(
      "motion.steer_var_rad2_m", o.noise.steer_var_rad2_m, {0.0, 1.0},
      "variance of the steering angle, rad^2, times the distance over which its error stays the same, m");
  schema.real("motion.speed_scale", o.speed_scale, {0.1, 10.0}, "true distance per measured distance");
  schema.real("motion.turn_scale", o.turn_scale, {0.1, 10.0}, "true turn per measured turn");
  schema.real("motion.turn_bias_degps", o.turn_bias_degps, {-100.0, 100.0},
              "turn rate that the odometry misses while the robot moves, degrees per second; is added to it");
  schema.real("motion.standing_below_mps", o.standing.below_mps, {0.0, 10.0},
              "speed below which the robot stands if it also turns by less than 0.02 rad/s, m/s; the turn "
              "rate then is a bias and is subtracted; 0 disables this",
              Shown::kAlways);
  schema.real(
      "motion.outer_point_m", o.outer_point_m, {0.0, 10.0},
      "lateral offset of the speed reference point from the robot's origin, on the outside of a turn, m");
  schema.real("motion.response_s", o.response_s, {-10.0, 10.0},
              "time from the stamp of a motion to the motion itself, s; above 0 for commands, which a robot "
              "follows late",
              Shown::kAlways);
}

void describe(Schema& schema, LandmarkSensor& s) {
  schema.real("sensor.x_m", s.x_m, {-100.0, 100.0},
              "position of the landmark sensor ahead of the robot's origin, m", Shown::kAlways);
  schema.real("sensor.y_m", s.y_m, {-100.0, 100.0},
              "position of the landmark sensor left of the robot's origin, m", Shown::kAlways);
  schema.real("sensor.yaw_deg", s.yaw_deg, {-360.0, 360.0},
              "yaw of the landmark sensor on the robot, degrees, positive to the left", Shown::kAlways);
  schema.real("sensor.range_scale", s.range_scale, {0.1, 10.0},
              "scale of ranges: reported range = scale * true range + sensor.range_offset_m", Shown::kAlways);
  schema.real("sensor.range_offset_m", s.range_offset_m, {-100.0, 100.0}, "offset of ranges, m",
              Shown::kAlways);
  schema.boolean("sensor.range_is_depth", s.range_is_depth,
                 "ranges are depths along the sensor's axis, as from a camera that measures apparent size");
  schema.real("sensor.range_sigma_m", s.range_sigma_m, {1e-6, 1e3}, "standard deviation of a range, m",
              Shown::kAlways);
  schema.real("sensor.range_sigma_ratio", s.range_sigma_ratio, {0.0, 1.0},
              "additional standard deviation of a range per metre of range", Shown::kAlways);
  schema.real("sensor.bearing_sigma_deg", s.bearing_sigma_deg, {1e-5, 180.0},
              "standard deviation of a bearing, degrees", Shown::kAlways);
  schema.real("sensor.shared_range_sigma_ratio", s.errors.shared_range_sigma_ratio, {0.0, 1.0},
              "standard deviation of the range scale that all observations share (calibration), relative; "
              "both filters estimate it; 0: no such error",
              Shown::kAlways);
  schema.real("sensor.shared_range_sigma_m", s.errors.shared_range_sigma_m, {0.0, 100.0},
              "standard deviation of the range offset that all observations share, m; 0: no such error",
              Shown::kAlways);
  schema.real(
      "sensor.shared_bearing_sigma_deg", s.errors.shared_bearing_sigma_deg, {0.0, 90.0},
      "standard deviation of the bearing offset that all observations share, degrees; 0: no such error");
  schema.real("sensor.bias_range_sigma_ratio", s.errors.bias_range_sigma_ratio, {0.0, 1.0},
              "standard deviation of the Gauss-Markov bias of the ranges to one landmark, per metre of "
              "range; 0: no bias",
              Shown::kAlways);
  schema.real(
      "sensor.bias_bearing_sigma_deg", s.errors.bias_bearing_sigma_deg, {0.0, 90.0},
      "standard deviation of the Gauss-Markov bias of the bearings to one landmark, degrees; 0: no bias",
      Shown::kAlways);
  schema.real("sensor.bias_distance_m", s.errors.bias_distance_m, {1e-3, 1e3},
              "distance travelled in which a Gauss-Markov bias decays to 37 % (1/e), m");
  schema.real("sensor.min_range_m", s.min_range_m, {0.0, 1e6}, "minimum range, m; shorter ones are dropped");
  schema.real("sensor.max_range_m", s.max_range_m, {0.0, 1e6}, "maximum range, m; longer ones are dropped");
  schema.real("sensor.field_of_view_deg", s.field_of_view_deg, {0.0, 360.0},
              "full horizontal field of view, degrees");
  schema.real(
      "sensor.detection_probability", s.detection_probability, {0.0, 0.999},
      "probability that a landmark in range and field of view is observed; 0 disables negative information");
  schema.real("sensor.delay_s", s.delay_s, {-10.0, 10.0},
              "delay of the stamps: time of the stamp less time of the observation, s", Shown::kAlways);
}

void describe(Schema& schema, CameraOptions& o) {
  schema.integer("camera.width_px", o.width_px, {16, 16384}, "width of the image, pixels");
  schema.integer("camera.height_px", o.height_px, {16, 16384}, "height of the image, pixels");
  schema.real("camera.fu_px", o.fu_px, {1.0, 1e6}, "horizontal focal length, pixels");
  schema.real("camera.fv_px", o.fv_px, {1.0, 1e6}, "vertical focal length, pixels");
  schema.real("camera.cu_px", o.cu_px, {-1e5, 1e5},
              "column of the principal point, pixels, counted from 0 at the centre of the first");
  schema.real("camera.cv_px", o.cv_px, {-1e5, 1e5},
              "row of the principal point, pixels, counted in the same way");
  schema.real("camera.k1", o.distortion.k1, {-100.0, 100.0},
              "radial distortion, second order (plumb bob model, as in ROS)");
  schema.real("camera.k2", o.distortion.k2, {-1e3, 1e3}, "radial distortion, fourth order");
  schema.real("camera.p1", o.distortion.p1, {-10.0, 10.0}, "first coefficient of tangential distortion");
  schema.real("camera.p2", o.distortion.p2, {-10.0, 10.0}, "second coefficient of tangential distortion");
  schema.real("camera.k3", o.distortion.k3, {-1e4, 1e4}, "radial distortion, sixth order");
  schema.real("camera.mount_x_m", o.mount.x_m, {-100.0, 100.0},
              "position of the camera ahead of the robot's origin, m", Shown::kAlways);
  schema.real("camera.mount_y_m", o.mount.y_m, {-100.0, 100.0},
              "position of the camera left of the robot's origin, m", Shown::kAlways);
  schema.real("camera.mount_z_m", o.mount.z_m, {-100.0, 100.0}, "height of the camera above the ground, m",
              Shown::kAlways);
  schema.real("camera.mount_roll_deg", o.mount.roll_deg, {-360.0, 360.0},
              "rotation of the camera about the robot's x axis (forward), degrees", Shown::kAlways);
  schema.real("camera.mount_pitch_deg", o.mount.pitch_deg, {-360.0, 360.0},
              "rotation of the camera about the robot's y axis (left), degrees, positive looks down",
              Shown::kAlways);
  schema.real("camera.mount_yaw_deg", o.mount.yaw_deg, {-360.0, 360.0},
              "rotation of the camera about the robot's z axis (up), degrees, positive looks left",
              Shown::kAlways);
}

void describe(Schema& schema, PipelineOptions& options) {
  schema.real("pipeline.reorder_window_s", options.reorder_window_s, {0.0, 60.0},
              "time by which an event may arrive late and still be sorted by its stamp, s; results are "
              "delayed by as much");
  schema.real("pipeline.max_hold_s", options.max_hold_s, {0.0, 3600.0},
              "time for which the last speed is used when odometry is missing, s");
}

}  // namespace waymark
