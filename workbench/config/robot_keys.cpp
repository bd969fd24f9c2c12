#include "workbench/config/robot_keys.hpp"

namespace waymark {

void describe(Schema& schema, OdometryOptions& o) {
  schema.real("wheels.left_radius_m", o.wheels.left_radius_m, {0.0, 10.0},
              "radius of the left wheel, m; 0: the log says", Shown::kAlways);
  schema.real("wheels.right_radius_m", o.wheels.right_radius_m, {0.0, 10.0},
              "radius of the right wheel, m; 0: the log says", Shown::kAlways);
  schema.real("wheels.track_m", o.wheels.track_m, {0.0, 100.0},
              "distance between the wheels, m; 0: the log says", Shown::kAlways);
  schema.real(
      "car.wheel_base_m", o.car.wheel_base_m, {0.0, 100.0},
      "of a steered car: from the rear axle, where its origin is, to the front one, m; 0: the log says");
  schema.real("car.encoder_offset_m", o.car.encoder_offset_m, {-10.0, 10.0},
              "how far left of the middle the rear wheel is whose speed is measured, m");
  schema.real("motion.wheel_var_m2_per_m", o.noise.wheel_var_m2_per_m, {0.0, 1.0},
              "error variance of each wheel per metre it rolls", Shown::kAlways);
  schema.real("motion.forward_var_m2_per_m", o.noise.forward_var_m2_per_m, {0.0, 1.0},
              "forward slip variance per metre driven");
  schema.real("motion.lateral_var_m2_per_m", o.noise.lateral_var_m2_per_m, {0.0, 1.0},
              "sideways slip variance per metre driven");
  schema.real("motion.turn_var_rad2_per_rad", o.noise.turn_var_rad2_per_rad, {0.0, 10.0},
              "turning error variance per radian turned", Shown::kAlways);
  schema.real("motion.turn_var_rad2_per_m", o.noise.turn_var_rad2_per_m, {0.0, 10.0},
              "turning error variance per metre driven");
  schema.real("motion.steer_var_rad2_m", o.noise.steer_var_rad2_m, {0.0, 1.0},
              "variance of a steering angle's error times the way on which one error lasts");
  schema.real("motion.speed_scale", o.speed_scale, {0.1, 10.0}, "true distance per measured distance");
  schema.real("motion.turn_scale", o.turn_scale, {0.1, 10.0}, "true turn per measured turn");
  schema.real("motion.turn_bias_degps", o.turn_bias_degps, {-100.0, 100.0},
              "what the odometry turns too little while the robot moves, degrees per second");
  schema.real(
      "motion.standing_below_mps", o.standing.below_mps, {0.0, 10.0},
      "a robot slower than this that also turns by less than 0.02 rad/s stands, m/s: what its odometry "
      "turns then is its bias, and taken out of what follows; 0: never");
  schema.real("motion.outer_point_m", o.outer_point_m, {0.0, 10.0},
              "how far out, on the outside of a turn, the point is whose speed is reported, m");
  schema.real("motion.response_s", o.response_s, {-10.0, 10.0},
              "how much later than its stamp a motion happens, s: a robot takes time to follow a command");
}

void describe(Schema& schema, LandmarkSensor& s) {
  schema.real("sensor.x_m", s.x_m, {-100.0, 100.0}, "landmark sensor ahead of the robot's origin, m",
              Shown::kAlways);
  schema.real("sensor.y_m", s.y_m, {-100.0, 100.0}, "landmark sensor left of the robot's origin, m",
              Shown::kAlways);
  schema.real("sensor.yaw_deg", s.yaw_deg, {-360.0, 360.0},
              "direction of the landmark sensor, degrees left of ahead", Shown::kAlways);
  schema.real("sensor.range_scale", s.range_scale, {0.1, 10.0}, "reported range per metre of true range");
  schema.real("sensor.range_offset_m", s.range_offset_m, {-100.0, 100.0},
              "by how much more than that is reported, m");
  schema.boolean("sensor.range_is_depth", s.range_is_depth,
                 "the range is measured along the sensor's axis, as a camera does that goes by size");
  schema.real("sensor.range_sigma_m", s.range_sigma_m, {1e-6, 1e3}, "standard deviation of a range, m",
              Shown::kAlways);
  schema.real("sensor.range_sigma_ratio", s.range_sigma_ratio, {0.0, 1.0},
              "further standard deviation per metre of range", Shown::kAlways);
  schema.real("sensor.bearing_sigma_deg", s.bearing_sigma_deg, {1e-5, 180.0},
              "standard deviation of a bearing, degrees", Shown::kAlways);
  schema.real(
      "sensor.shared_range_sigma_ratio", s.errors.shared_range_sigma_ratio, {0.0, 1.0},
      "standard deviation of what all ranges of a log have in common, per metre; both filters estimate it");
  schema.real("sensor.shared_range_sigma_m", s.errors.shared_range_sigma_m, {0.0, 100.0},
              "the same of an offset of all ranges");
  schema.real("sensor.shared_bearing_sigma_deg", s.errors.shared_bearing_sigma_deg, {0.0, 90.0},
              "the same of all bearings, degrees");
  schema.real("sensor.bias_range_sigma_ratio", s.errors.bias_range_sigma_ratio, {0.0, 1.0},
              "standard deviation of what successive ranges to one landmark have in common, per metre");
  schema.real("sensor.bias_bearing_sigma_deg", s.errors.bias_bearing_sigma_deg, {0.0, 90.0},
              "the same of bearings, degrees");
  schema.real("sensor.bias_distance_m", s.errors.bias_distance_m, {1e-3, 1e3},
              "way after which 37 % of what successive observations have in common are left, m");
  schema.real("sensor.min_range_m", s.min_range_m, {0.0, 1e6}, "shortest range that counts, m");
  schema.real("sensor.max_range_m", s.max_range_m, {0.0, 1e6}, "longest range that counts, m");
  schema.real("sensor.field_of_view_deg", s.field_of_view_deg, {0.0, 360.0}, "full opening angle, degrees");
  schema.real("sensor.detection_probability", s.detection_probability, {0.0, 0.999},
              "chance that a landmark within these limits is reported; 0 disables negative information");
  schema.real("sensor.delay_s", s.delay_s, {-10.0, 10.0},
              "how much later than the observation its stamp is, s");
}

void describe(Schema& schema, CameraOptions& o) {
  schema.integer("camera.width_px", o.width_px, {16, 16384}, "width of the image");
  schema.integer("camera.height_px", o.height_px, {16, 16384}, "height of the image");
  schema.real("camera.fu_px", o.fu_px, {1.0, 1e6}, "focal length along the rows, pixels");
  schema.real("camera.fv_px", o.fv_px, {1.0, 1e6}, "focal length along the columns, pixels");
  schema.real("camera.cu_px", o.cu_px, {-1e5, 1e5}, "column of the principal point; the first pixel is 0");
  schema.real("camera.cv_px", o.cv_px, {-1e5, 1e5}, "row of the principal point");
  schema.real("camera.k1", o.distortion.k1, {-100.0, 100.0}, "radial distortion, plumb bob as in ROS");
  schema.real("camera.k2", o.distortion.k2, {-1e3, 1e3}, "radial distortion, fourth order");
  schema.real("camera.p1", o.distortion.p1, {-10.0, 10.0}, "tangential distortion");
  schema.real("camera.p2", o.distortion.p2, {-10.0, 10.0}, "tangential distortion");
  schema.real("camera.k3", o.distortion.k3, {-1e4, 1e4}, "radial distortion, sixth order");
  schema.real("camera.mount_x_m", o.mount.x_m, {-100.0, 100.0}, "camera ahead of the robot's origin, m",
              Shown::kAlways);
  schema.real("camera.mount_y_m", o.mount.y_m, {-100.0, 100.0}, "camera left of it, m", Shown::kAlways);
  schema.real("camera.mount_z_m", o.mount.z_m, {-100.0, 100.0}, "camera above the ground, m", Shown::kAlways);
  schema.real("camera.mount_roll_deg", o.mount.roll_deg, {-360.0, 360.0},
              "turn of the camera about the robot's x axis, degrees", Shown::kAlways);
  schema.real("camera.mount_pitch_deg", o.mount.pitch_deg, {-360.0, 360.0},
              "... about its y axis, positive looks down", Shown::kAlways);
  schema.real("camera.mount_yaw_deg", o.mount.yaw_deg, {-360.0, 360.0},
              "... about its z axis, positive looks left", Shown::kAlways);
}

void describe(Schema& schema, PipelineOptions& options) {
  schema.real("pipeline.reorder_window_s", options.reorder_window_s, {0.0, 60.0},
              "how late an event may arrive and still be put in its place, s");
  schema.real("pipeline.max_hold_s", options.max_hold_s, {0.0, 3600.0},
              "how long the last speed is believed when odometry is missing, s");
}

}  // namespace waymark
