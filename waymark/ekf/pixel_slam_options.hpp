#pragma once

#include "waymark/ekf/consistency.hpp"
#include "waymark/ekf/depth_prior.hpp"

namespace waymark {

namespace ekf {

/// When a point that was seen once takes part in the estimate.
enum class Initialization {
  kDelayed,  ///< once particles have found out its depth, as a ray (Davison 2003)
  kArticle   ///< once particles have found out its depth, as a point (Vincke et al. 2012)
};

}  // namespace ekf

/// How updates are computed.
enum class UpdateMethod {
  kFast,     ///< only what H touches, as P -= W^T W
  kTextbook  ///< with dense matrices and plain loops, to compare with: needs Consistency::kStandard
};

struct PixelSlamOptions {
  int capacity = 100;              ///< most landmarks in the map
  double sigma_px = 0.5;           ///< of pixels that came without covariance
  double model_sigma_px = 0.1;     ///< what every pixel is off besides, anew in every image
  double landmark_noise_px = 0.1;  ///< how far a patch drifts while the view of it turns by 1 deg
  double jitter_deg = 0.05;        ///< of the camera's pitch and roll, anew in every image
  ekf::Initialization init = ekf::Initialization::kDelayed;
  ekf::DepthPrior depth;
  int max_candidates = 8;
  ekf::Consistency consistency = ekf::Consistency::kInvariant;
  UpdateMethod update = UpdateMethod::kFast;
};

}  // namespace waymark
