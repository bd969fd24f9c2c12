#pragma once

namespace waymark::ekf {

/// Which landmark makes room for a new one when the map is full.
enum class Eviction {
  kInformation,  ///< the one whose observations tell least about where the robot is
  kArticle,      ///< the one with the largest robot block of I - K H, as Vincke et al. 2012
  kNone,         ///< none: the new one is refused
};

}  // namespace waymark::ekf
