#pragma once

#include "waymark/kernels/instructions.hpp"
#include "waymark/vision/corner_options.hpp"

namespace waymark::vision {

/// What a match makes small, for z = ZMSSD, d = pixel - predicted and innovation covariance S. kMap is the
/// negative logarithm of the posterior under grey noise of `grey_sigma`; kArticle is as printed (Vincke et
/// al. 2012), read so that it favours the middle of the ellipse.
enum class MatchScore {
  kMap,      ///< z / (4 sigma^2) + d^T S^-1 d / 2
  kArticle,  ///< z / exp(-d^T S^-1 d / 2)
};

struct SearchOptions {
  double probability = 0.9999;  ///< part of the true places that lie inside the search ellipse
  int max_windows = 2500;       ///< of one search; larger ellipses are searched at corners only
  MatchScore match = MatchScore::kMap;
  double grey_sigma = 3.0;    ///< noise of a pixel, grey levels
  double accept_ratio = 1.5;  ///< of the ZMSSD that the right place is expected to have
  CornerOptions corners{.threshold = 15, .arc = 9};  ///< of the search at corners
  kernels::Instructions instructions = kernels::Instructions::kSimd;
};

}  // namespace waymark::vision
