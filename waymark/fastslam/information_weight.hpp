#pragma once

namespace waymark::fastslam {

/// How much of an observation's likelihood the weights of particles take. A landmark under watch says little
/// about where the path as a whole went, and its errors are alike from frame to frame; weights that count
/// every frame in full make the set forget its own past by resampling long before a loop closes (Bailey,
/// Nieto, Nebot 2006 \cite bailey2006fastslam).
class InformationWeight {
 public:
  /// `information_distance_m`: FastSlamOptions::information_distance_m; 0: every observation counts in full.
  explicit InformationWeight(double information_distance_m)
      : information_distance_m_(information_distance_m) {}

  /// The power e = 1 - exp(-w / information_distance_m) of the likelihood, w the distance travelled since the
  /// landmark was last observed: 1 after a long distance, nearly 0 for one that has just been observed.
  [[nodiscard]] double power(double travelled_since_m) const;

 private:
  double information_distance_m_;
};

}  // namespace waymark::fastslam
