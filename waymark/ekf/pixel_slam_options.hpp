#pragma once

#include "waymark/ekf/consistency.hpp"
#include "waymark/ekf/depth_prior.hpp"
#include "waymark/ekf/eviction.hpp"

namespace waymark {

namespace ekf {

/// When a point that was seen once takes part in the estimate.
enum class Initialization {
  kDelayed,       ///< once particles have found out its depth, as a ray (Davison 2003)
  kInverseDepth,  ///< at once, as a ray of unsure depth (Civera, Davison, Montiel 2008)
  kArticle        ///< once particles have found out its depth, as a point (Vincke et al. 2012)
};

}  // namespace ekf

/// How updates are computed.
enum class UpdateMethod {
  kFast,     ///< only what H touches, as P -= W^T W
  kTextbook  ///< with dense matrices and plain loops, to compare with: needs Consistency::kStandard
};

struct PixelSlamOptions {
  int capacity = 100;                ///< most landmarks in the map
  double sigma_px = 0.5;             ///< of pixels that came without covariance
  double model_sigma_px = 0.1;       ///< what every pixel is off besides, anew in every image
  double landmark_noise_px = 0.1;    ///< how far a patch wanders while the view of it turns by 1 deg
  double jitter_deg = 0.05;          ///< of the camera's pitch and roll, anew in every image
  double gate_probability = 0.9999;  ///< part of the true observations that may pass
  ekf::Initialization init = ekf::Initialization::kDelayed;
  ekf::DepthPrior depth;
  int max_candidates = 8;
  int min_images = 8;        ///< in which a candidate is seen before it is accepted at all
  int max_images = 15;       ///< in which a candidate is seen before it is accepted without depth
  double depth_ratio = 0.3;  ///< sigma of the depth over the depth at which a candidate is accepted
  ekf::Consistency consistency = ekf::Consistency::kInvariant;
  ekf::Eviction evict = ekf::Eviction::kInformation;
  UpdateMethod update = UpdateMethod::kFast;
};

}  // namespace waymark
