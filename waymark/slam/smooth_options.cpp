#include "waymark/slam/smooth_options.hpp"

namespace waymark {

void describe(Schema& schema, SmoothOptions& o) {
  schema.boolean("smooth.run", o.run,
                 "estimate the whole path and map once more, from the whole log, when it has ended");
  schema.real("smooth.robust_dof", o.robust_dof, {1.0, 1e6},
              "degrees of freedom of the Student-t distribution of all errors there: the fewer, the less "
              "outliers count");
  schema.integer("smooth.most_iterations", o.most_iterations, {1, 1000}, "when to stop at the latest");
  schema.boolean("smooth.odometry_is_commanded", o.odometry_is_commanded,
                 "what is logged are commands, from which the robot strays; else it was measured, and it is "
                 "the measurements that err");
  schema.real("smooth.least_leg_m", o.least_leg_m, {0.0, 1000.0},
              "what is seen nearer than this to the last pose that is estimated, and after less turning than "
              "smooth.least_leg_deg, is left out, m");
  schema.real("smooth.least_leg_deg", o.least_leg_deg, {0.0, 360.0}, "the turning there, degrees");
  schema.real(
      "smooth.speed_scale_sigma", o.speed_scale_sigma, {0.0, 1.0},
      "standard deviation of the true distance per measured distance, which is estimated; 0: it is 1");
  schema.real("smooth.turn_scale_sigma", o.turn_scale_sigma, {0.0, 1.0},
              "the same of the true turn per measured turn");
  schema.real("smooth.turn_bias_sigma_degps", o.turn_bias_sigma_degps, {0.0, 100.0},
              "the same of what the odometry turns by itself while the robot moves, degrees per second; 0: "
              "nothing");
  schema.real("smooth.turn_per_m_sigma_deg", o.turn_per_m_sigma_deg, {0.0, 1000.0},
              "the same of what the odometry turns by itself per metre, as with wheels of different size, "
              "degrees; 0: nothing");
  schema.real("smooth.mount_sigma_m", o.mount_sigma_m, {0.0, 100.0},
              "the same of where the landmark sensor sits on the robot, m; 0: where the config says");
  schema.real("smooth.mount_yaw_sigma_deg", o.mount_yaw_sigma_deg, {0.0, 180.0},
              "the same of where it looks, beside what sensor.shared_bearing_sigma_deg says, degrees");
  schema.real("smooth.delay_sigma_s", o.delay_sigma_s, {0.0, 10.0},
              "the same of how late its stamps are, s; 0: as sensor.delay_s says");
}

}  // namespace waymark
