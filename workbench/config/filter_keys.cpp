#include "workbench/config/filter_keys.hpp"

namespace waymark {
namespace {

bool resamples_always(const FastSlamOptions& o) { return o.resample_below == 1.0 && o.temper_below == 0.0; }

void resample_always(FastSlamOptions& o, bool always) {
  const FastSlamOptions usual;
  o.resample_below = always ? 1.0 : usual.resample_below;
  o.temper_below = always ? 0.0 : usual.temper_below;
}

}  // namespace

void describe(Schema& schema, GateOptions& options) {
  schema.real("gate.probability", options.probability, {0.5, 1.0},
              "probability that a correct observation passes the gate; 1 disables the gate");
}

void describe(Schema& schema, AssociationOptions& o) {
  schema.real("association.false_alarm_probability", o.false_alarm_probability, {1e-6, 0.5},
              "probability per scan that a landmark which does not exist appears to be observed");
  schema.real("association.clutter_per_scan", o.clutter_per_scan, {1e-6, 1e4},
              "mean number of false observations (clutter) in a scan");
  schema.real("association.landmarks_per_m2", o.landmarks_per_m2, {0.0, 1e3},
              "density of landmarks that are not in the map yet, per m^2");
}

void describe(Schema& schema, EkfOptions& options) {
  schema.choice("ekf.consistency", options.consistency, {"invariant", "fej", "standard"},
                "linearisation: invariant error, fej (first-estimates Jacobians) or standard (latest "
                "estimate, as in Vincke et al. 2012)",
                Shown::kAlways);
  schema.integer("ekf.iterations", options.iterations, {0, 20},
                 "maximum number of relinearisations in an update that is strongly nonlinear (iterated "
                 "update); 0 disables them");
  schema.choice("ekf.likelihood", options.likelihood, {"gaussian", "student"},
                "distribution of observation errors; student has heavy tails, for outliers within the gate, "
                "and relinearises up to 3 times");
  schema.choice(
      "ekf.compressed", options.compressed, {"auto", "true", "false"},
      "compressed EKF, for large maps: an update changes only the active submap, at a cost that does "
      "not grow with the map; auto: once the map is large enough");
  describe(schema, options.odometry);
}

void describe(Schema& schema, OdometryStateOptions& o) {
  schema.boolean(
      "ekf.calibrate_odometry", o.estimate,
      "also estimate odometry calibration: scales of speed and turn, and turn bias; writes calibration.yaml",
      Shown::kAlways);
}

void describe(Schema& schema, PixelSlamOptions& options) {
  schema.real("pixel.sigma_px", options.sigma_px, {1e-3, 100.0},
              "standard deviation of logged pixels that have no covariance, px");
  schema.real("pixel.model_sigma_px", options.model_sigma_px, {0.0, 100.0},
              "additional standard deviation of every pixel, px; covers errors of camera and motion model");
  schema.real("pixel.landmark_noise_px", options.landmark_noise_px, {0.0, 100.0},
              "landmark process noise: standard deviation of a patch's drift on its surface while the view "
              "turns by 1 degree, px; grows with the root of the angle");
  schema.real("pixel.nearest_m", options.depth.nearest_m, {0.01, 1000.0},
              "smallest possible depth of a new landmark, m");
  schema.real("pixel.farthest_m", options.depth.farthest_m, {0.1, 1e6},
              "largest possible depth of a new landmark, m");
  schema.integer("pixel.max_candidates", options.max_candidates, {1, 100},
                 "maximum number of new landmarks whose depth is being estimated at once");
}

void describe(Schema& schema, FastSlamOptions& o) {
  schema.choice("fastslam.proposal", o.proposal, {"1.0", "2.0"},
                "1.0 draws poses from the odometry alone, 2.0 from odometry and observations");
  schema.integer("fastslam.particles", o.particles, {1, 10'000'000}, "number of particles", Shown::kAlways);
  schema.boolean(
      "fastslam.always_resample", [&o] { return resamples_always(o); },
      [&o](bool always) { resample_always(o, always); },
      "true: resample at every step; false: only if N_eff falls below half, with weights tempered to keep "
      "N_eff above a tenth");
  schema.real("fastslam.enkf_above", o.enkf_above, {0.0, 1e9},
              "use the EnKF update where spread / noise of predicted innovations exceeds this, for 100 "
              "particles; scales with their number; 1e9 disables it");
  schema.real("fastslam.noise_inflation", o.noise_inflation, {0.1, 100.0},
              "factor on the standard deviations of observations; above 1 if few particles degenerate");
  schema.real("fastslam.information_distance_m", o.information_distance_m, {0.0, 1000.0},
              "distance travelled after which a landmark that is observed again has 63 % of its weight, m; "
              "0: always full weight");
}

void describe(Schema& schema, SmoothOptions& o) {
  schema.boolean("smooth.run", o.run,
                 "after the log has ended, estimate the whole path and map again from all of it",
                 Shown::kAlways);
  schema.real("smooth.robust_dof", o.robust_dof, {1.0, 1e6},
              "degrees of freedom of the Student-t distribution of all errors; fewer trust outliers less");
  schema.boolean("smooth.odometry_is_commanded", o.odometry_is_commanded,
                 "odometry is commanded, not measured: the robot deviates from exact commands");
  schema.real("smooth.keyframe_distance_m", o.keyframe_distance_m, {0.0, 1000.0},
              "minimum distance between keyframes, m; observations before that and smooth.keyframe_turn_deg "
              "are left out; 0 keeps all",
              Shown::kAlways);
  schema.real("smooth.keyframe_turn_deg", o.keyframe_turn_deg, {0.0, 360.0},
              "minimum turn between keyframes, degrees; a keyframe is made once distance or turn is reached; "
              "0 keeps all",
              Shown::kAlways);
  schema.real("smooth.turn_per_m_sigma_deg", o.turn_per_m_sigma_deg, {0.0, 1000.0},
              "standard deviation of a turn bias per metre driven (wheels of different size), degrees per "
              "metre; 0: not estimated");
  schema.real("smooth.mount_sigma_m", o.mount_sigma_m, {0.0, 100.0},
              "standard deviation of the position of the landmark sensor on the robot, m; 0: not estimated");
  schema.real("smooth.mount_yaw_sigma_deg", o.mount_yaw_sigma_deg, {0.0, 180.0},
              "standard deviation of the yaw of the landmark sensor on the robot, added to "
              "sensor.shared_bearing_sigma_deg, degrees; 0: nothing to add");
  schema.real("smooth.delay_sigma_s", o.delay_sigma_s, {0.0, 10.0},
              "standard deviation of sensor.delay_s, s; 0: not estimated");
  schema.real("motion.speed_scale_sigma", o.speed_scale_sigma, {0.0, 1.0},
              "relative standard deviation of motion.speed_scale, where ekf.calibrate_odometry or smooth.run "
              "estimate it; 0: not estimated");
  schema.real("motion.turn_scale_sigma", o.turn_scale_sigma, {0.0, 1.0},
              "relative standard deviation of motion.turn_scale, where it is estimated; 0: not estimated");
  schema.real("motion.turn_bias_sigma_degps", o.turn_bias_sigma_degps, {0.0, 100.0},
              "standard deviation of motion.turn_bias_degps, where it is estimated, degrees per second; 0: "
              "not estimated");
}

}  // namespace waymark
