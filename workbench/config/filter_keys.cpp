#include "workbench/config/filter_keys.hpp"

namespace waymark {

void describe(Schema& schema, GateOptions& options) {
  schema.real("gate.probability", options.probability, {0.5, 1.0},
              "part of the true sightings that may pass the gate; 1 lets all pass");
}

void describe(Schema& schema, AssociationOptions& o) {
  schema.real("association.false_alarm_probability", o.false_alarm_probability, {1e-6, 0.5},
              "chance per scan that something else is taken for a landmark");
  schema.real("association.clutter_per_scan", o.clutter_per_scan, {1e-6, 1e4},
              "sightings of nothing per scan");
  schema.real("association.landmarks_per_m2", o.landmarks_per_m2, {0.0, 1e3},
              "density of landmarks that are not known yet");
  schema.real("association.confirmed_log_odds", o.confirmed_log_odds, {0.0, 1e3},
              "log-odds of existence from which a landmark counts in the map");
  schema.real("association.most_log_odds", o.most_log_odds, {0.0, 1e3},
              "largest log-odds of existence: how many misses in a row delete a landmark");
  schema.integer("association.most_pairings", o.most_pairings, {1, 1000000},
                 "pairs of sighting and landmark that associate=jcbb tries per scan before it takes the best "
                 "hypothesis so far");
}

void describe(Schema& schema, EkfOptions& options) {
  schema.choice(
      "ekf.consistency", options.consistency, {"invariant", "fej", "standard"},
      "where the filter linearises: invariant error, first estimates, or latest estimates as in the article");
  schema.integer("ekf.capacity", options.capacity, {1, 20000},
                 "most landmarks in the map; memory is taken once");
  schema.choice(
      "ekf.evict", options.evict, {"information", "article", "none"},
      "which landmark leaves a full map: the one that told least about the pose, the one of largest I - K H "
      "as in the article, or none, so that new ones are refused");
  schema.integer("ekf.iterations", options.iterations, {0, 20},
                 "how often an update may be linearised anew where it leaves the linear; 0: never");
  schema.choice(
      "ekf.likelihood", options.likelihood, {"gaussian", "student"},
      "student: heavy tails, for outliers that no gate finds; takes up to 3 iterations in any case");
  schema.choice("ekf.compressed", options.compressed, {"auto", "true", "false"},
                "whether a large map is updated region by region, at the cost of a small one; auto: once it "
                "is large enough to gain");
  describe(schema, options.odometry);
  schema.integer("ekf.region", options.region, {48, 20000},
                 "landmarks in a region of a compressed map; more where so many are seen at once");
}

void describe(Schema& schema, OdometryStateOptions& o) {
  schema.boolean(
      "ekf.calibrate_odometry", o.estimate,
      "estimate what is always wrong with the odometry: scales of speed and turning, and a turning "
      "rate that is missing; the result is in calibration.yaml");
  schema.real("ekf.speed_scale_sigma", o.speed_scale_sigma, {0.0, 1.0},
              "standard deviation of the true distance per measured distance then; 0: it is 1");
  schema.real("ekf.turn_scale_sigma", o.turn_scale_sigma, {0.0, 1.0},
              "the same of the true turn per measured turn");
  schema.real("ekf.turn_bias_sigma_degps", o.turn_bias_sigma_degps, {0.0, 100.0},
              "the same of what the odometry turns too little while the robot moves, degrees per second");
}

void describe(Schema& schema, PixelSlamOptions& options) {
  schema.integer("pixel.capacity", options.capacity, {1, 2000}, "most landmarks in the map");
  schema.real("pixel.sigma_px", options.sigma_px, {1e-3, 100.0},
              "standard deviation of pixels that came without covariance, px");
  schema.real("pixel.model_sigma_px", options.model_sigma_px, {0.0, 100.0},
              "what every pixel is off besides, anew in every picture, px");
  schema.real(
      "pixel.wander_px", options.wander_px, {0.0, 100.0},
      "standard deviation of how far the place of a patch wanders on its surface while the view of it "
      "turns by 1 deg, px; grows with the root of the angle");
  schema.real("pixel.vibration_deg", options.vibration_deg, {0.0, 10.0},
              "standard deviation of the camera's pitch and roll, anew in every picture, deg");
  schema.real("pixel.gate_probability", options.gate_probability, {0.5, 0.9999999},
              "part of the true sightings that may pass the gates");
  schema.choice(
      "pixel.init", options.init, {"delayed", "inverse-depth", "article"},
      "when a new point takes part: once particles have found out its depth, at once by inverse depth, "
      "or as delayed but as a point, as in the article");
  schema.integer("pixel.depth_particles", options.depth.particles, {2, 10000},
                 "depth particles of a candidate");
  schema.real("pixel.nearest_m", options.depth.nearest_m, {0.01, 1000.0}, "smallest depth of a new point, m");
  schema.real("pixel.farthest_m", options.depth.farthest_m, {0.1, 1e6}, "largest depth of a new point, m");
  schema.choice("pixel.depth_spacing", options.depth.spacing, {"inverse-depth", "depth"},
                "in what the depth of a new point is uniform; depth: as in the article");
  schema.integer("pixel.most_candidates", options.most_candidates, {1, 100},
                 "points whose depth is being found out at once");
  schema.integer("pixel.least_pictures", options.least_pictures, {1, 100000},
                 "sightings before a candidate is accepted: what moves by itself shows within these");
  schema.integer(
      "pixel.most_pictures", options.most_pictures, {1, 100000},
      "sightings after which a candidate is accepted though its depth is not known; after twice as "
      "many pictures it is given up");
  schema.real("pixel.depth_ratio", options.depth_ratio, {1e-3, 1.0},
              "sigma of the depth over the depth below which a candidate is accepted");
  schema.choice(
      "ekf.update", options.update, {"fast", "textbook"},
      "textbook: of pixels, with dense matrices and plain loops as in the article, to compare with; "
      "needs ekf.consistency=standard");
}

void describe(Schema& schema, FastSlamOptions& o) {
  schema.choice("fastslam.proposal", o.proposal, {"1.0", "2.0"},
                "FastSLAM 1.0 draws from the odometry alone, 2.0 from odometry and sightings");
  schema.choice("fastslam.init", o.init, {"anchored", "guess"},
                "a landmark seen by range or bearing alone begins as all that this allows, or each particle "
                "guesses where it is");
  schema.integer("fastslam.particles", o.particles, {1, 10'000'000}, "number of particles");
  schema.real("fastslam.resample_below", o.resample_below, {0.0, 1.0},
              "resample when the effective number of particles falls below this part of them");
  schema.real(
      "fastslam.temper_below", o.temper_below, {0.0, 1.0},
      "flatten the weights when the effective number of particles would fall below this part of them");
  schema.real(
      "fastslam.move_above", o.move_above, {0.0, 1e9},
      "move 100 particles and their maps, instead of weighing them, where what they expect to see varies "
      "by more than this part of its noise; n times as many by n times as much");
  schema.real("fastslam.noise_inflation", o.noise_inflation, {0.1, 100.0},
              "factor on the standard deviations of observations; few particles need a blunter sensor");
  schema.real(
      "fastslam.evidence_way_m", o.evidence_way_m, {0.0, 1000.0},
      "a landmark seen again after this way counts 63 % in the weights; 0: every sighting counts in full");
  schema.real(
      "fastslam.kld_error", o.kld_error, {0.0, 1.0},
      "keep as many particles, up to fastslam.particles, as hold this Kullback-Leibler distance to the "
      "belief, usually 0.05; 0: always the same number");
  schema.integer("fastslam.kld_least", o.kld_least, {1, 10'000'000}, "fewest particles to keep then");
  schema.integer("fastslam.capacity", o.capacity, {1, 1'000'000}, "most landmarks in the map");
}

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
