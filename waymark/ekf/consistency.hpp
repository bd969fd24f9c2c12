#pragma once

namespace waymark::ekf {

/// At which point the filter linearises, which decides whether it fools itself about its heading.
enum class Consistency {
  kInvariant,  ///< right-invariant error (Barrau and Bonnabel 2015) in ordinary coordinates: a shear after
               ///< each update
  kFej,        ///< first-estimates Jacobians (Huang, Mourikis, Roumeliotis 2010)
  kStandard,   ///< at the latest estimate, as in the 2012 article; overconfident when the odometry is poor
};

}  // namespace waymark::ekf
