#pragma once

namespace waymark {

/// Whether and how the whole path is estimated again when the log has ended. What observations have in common
/// (scale and offset of ranges, offset of bearings) is estimated where sensor.shared_* says that there may be
/// something.
struct SmoothOptions {
  bool run = false;
  double robust_dof = 4.0;             ///< of the Student-t distribution of all errors
  bool odometry_is_commanded = false;  ///< the robot strays from its odometry, and not this from the robot
  double keyframe_distance_m = 0.0;    ///< between poses that are estimated,
  double keyframe_turn_deg = 0.0;      ///< or at least this much turning
  double speed_scale_sigma = 0.05;
  double turn_scale_sigma = 0.05;
  double turn_bias_sigma_degps = 0.1;
  double turn_per_m_sigma_deg = 0.0;
  double mount_sigma_m = 0.0;
  double mount_yaw_sigma_deg = 0.0;
  double delay_sigma_s = 0.0;
};

}  // namespace waymark
