#include "waymark/ekf/pixel_slam_options.hpp"

namespace waymark {

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
}

}  // namespace waymark
