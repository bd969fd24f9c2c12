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
              "part of the true observations that may pass the gate; 1 lets all pass");
}

void describe(Schema& schema, AssociationOptions& o) {
  schema.real("association.false_alarm_probability", o.false_alarm_probability, {1e-6, 0.5},
              "chance per scan that something else is taken for a landmark");
  schema.real("association.clutter_per_scan", o.clutter_per_scan, {1e-6, 1e4},
              "observations of nothing per scan");
  schema.real("association.landmarks_per_m2", o.landmarks_per_m2, {0.0, 1e3},
              "density of landmarks that are not known yet");
}

void describe(Schema& schema, EkfOptions& options) {
  schema.choice(
      "ekf.consistency", options.consistency, {"invariant", "fej", "standard"},
      "where the filter linearises: invariant error, first estimates, or latest estimates as in the article",
      Shown::kAlways);
  schema.integer("ekf.iterations", options.iterations, {0, 20},
                 "how often an update may be linearised anew where it leaves the linear; 0: never");
  schema.choice(
      "ekf.likelihood", options.likelihood, {"gaussian", "student"},
      "student: heavy tails, for outliers that no gate finds; takes up to 3 iterations in any case");
  schema.choice("ekf.compressed", options.compressed, {"auto", "true", "false"},
                "whether a large map is updated submap by submap, at the cost of a small one; auto: once it "
                "is large enough to gain");
  describe(schema, options.odometry);
}

void describe(Schema& schema, OdometryStateOptions& o) {
  schema.boolean(
      "ekf.calibrate_odometry", o.estimate,
      "estimate what is always wrong with the odometry: scales of speed and turning, and a turning "
      "rate that is missing; the result is in calibration.yaml",
      Shown::kAlways);
}

void describe(Schema& schema, PixelSlamOptions& options) {
  schema.real("pixel.sigma_px", options.sigma_px, {1e-3, 100.0},
              "standard deviation of pixels that came without covariance, px");
  schema.real("pixel.model_sigma_px", options.model_sigma_px, {0.0, 100.0},
              "what every pixel is off besides, anew in every image, px");
  schema.real(
      "pixel.landmark_noise_px", options.landmark_noise_px, {0.0, 100.0},
      "standard deviation of how far the place of a patch wanders on its surface while the view of it "
      "turns by 1 deg, px; grows with the root of the angle");
  schema.real("pixel.nearest_m", options.depth.nearest_m, {0.01, 1000.0}, "smallest depth of a new point, m");
  schema.real("pixel.farthest_m", options.depth.farthest_m, {0.1, 1e6}, "largest depth of a new point, m");
}

void describe(Schema& schema, FastSlamOptions& o) {
  schema.choice("fastslam.proposal", o.proposal, {"1.0", "2.0"},
                "FastSLAM 1.0 draws from the odometry alone, 2.0 from odometry and observations");
  schema.integer("fastslam.particles", o.particles, {1, 10'000'000}, "number of particles", Shown::kAlways);
  schema.boolean(
      "fastslam.always_resample", [&o] { return resamples_always(o); },
      [&o](bool always) { resample_always(o, always); },
      "resample at every step by the weights as they are; else only when half of the particles would be "
      "left, "
      "by weights that keep a tenth of them");
  schema.real(
      "fastslam.enkf_above", o.enkf_above, {0.0, 1e9},
      "use the EnKF update where the spread of predicted innovations over their noise exceeds this, for 100 "
      "particles; grows in proportion to their number");
  schema.real("fastslam.noise_inflation", o.noise_inflation, {0.1, 100.0},
              "factor on the standard deviations of observations; few particles need a blunter sensor");
  schema.real(
      "fastslam.information_distance_m", o.information_distance_m, {0.0, 1000.0},
      "a landmark seen again after this way counts 63 % in the weights; 0: every observation counts in full");
}

void describe(Schema& schema, SmoothOptions& o) {
  schema.boolean("smooth.run", o.run,
                 "estimate the whole path and map once more, from the whole log, when it has ended",
                 Shown::kAlways);
  schema.real("smooth.robust_dof", o.robust_dof, {1.0, 1e6},
              "degrees of freedom of the Student-t distribution of all errors there: the fewer, the less "
              "outliers count");
  schema.boolean("smooth.odometry_is_commanded", o.odometry_is_commanded,
                 "what is logged are commands, from which the robot strays; else it was measured, and it is "
                 "the measurements that err");
  schema.real("smooth.keyframe_distance_m", o.keyframe_distance_m, {0.0, 1000.0},
              "what is seen nearer than this to the last pose that is estimated, and after less turning than "
              "smooth.keyframe_turn_deg, is left out, m");
  schema.real("smooth.keyframe_turn_deg", o.keyframe_turn_deg, {0.0, 360.0}, "the turning there, degrees");
  schema.real(
      "smooth.turn_per_m_sigma_deg", o.turn_per_m_sigma_deg, {0.0, 1000.0},
      "standard deviation of what the odometry turns by itself per metre, as with wheels of different size, "
      "degrees; 0: nothing");
  schema.real("smooth.mount_sigma_m", o.mount_sigma_m, {0.0, 100.0},
              "the same of where the landmark sensor sits on the robot, m; 0: where the config says");
  schema.real("smooth.mount_yaw_sigma_deg", o.mount_yaw_sigma_deg, {0.0, 180.0},
              "the same of where it looks, beside what sensor.shared_bearing_sigma_deg says, degrees");
  schema.real("smooth.delay_sigma_s", o.delay_sigma_s, {0.0, 10.0},
              "the same of how late its stamps are, s; 0: as sensor.delay_s says");
}

}  // namespace waymark
