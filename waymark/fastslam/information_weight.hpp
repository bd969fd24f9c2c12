#pragma once

namespace waymark::fastslam {

/// Observations of a landmark that are nearer to each other than this are as good as one.
inline constexpr double kMinTravelled_m = 1e-3;

/// How much of an observation's likelihood the weights of particles take. A landmark under watch says little
/// about where the path as a whole went, and its errors are alike from frame to frame; weights that count
/// every frame in full make the set forget its own past by resampling long before a loop closes (Bailey,
/// Nieto, Nebot 2006 \cite bailey2006fastslam).
class InformationWeight {
 public:
  /// `information_distance_m`: FastSlamOptions::information_distance_m; 0: every observation counts in full.
  explicit InformationWeight(double information_distance_m)
      : information_distance_m_(information_distance_m) {}

  /// The power e = 1 - exp(-w / information_distance_m) of the likelihood, w the way since the landmark was
  /// last seen: 1 for one that comes back after a long way, next to nothing for one that has just been seen.
  [[nodiscard]] double power(double travelled_since_m) const;

 private:
  double information_distance_m_;
};

/// By how much an error that falls to exp(-w / l) after a way w, l = `bias_distance_m`, counts for more than
/// one that is drawn anew: a run of observations a way w apart brings as much information, each, as one would
/// whose variance is coth(w / (2 l)) times as large and that errs anew every time.
[[nodiscard]] double bias_variance_factor(double travelled_since_m, double bias_distance_m);

}  // namespace waymark::fastslam
