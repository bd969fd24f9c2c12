#pragma once

#include <optional>

#include "waymark/core/event.hpp"
#include "waymark/core/motion.hpp"
#include "waymark/models/odometry.hpp"
#include "waymark/slam/gyro_findings.hpp"
#include "waymark/slam/yaw_rate_track.hpp"

namespace waymark {

/// Holds the heading of the odometry by a gyro, whose rate has white noise and a bias that walks slowly.
///
/// The gyro is on trial until it has turned as the odometry did, 0.3 rad in all, or 0.5 rad beside an
/// odometry that never turns; the trial finds its sign, and degrees in place of radians. From then on the
/// turn of a step is the mean of both, weighted by their variances, which nearly is the gyro's.
///
/// The bias, and the white noise, are learnt while the wheels stand; until they first do, the bias while they
/// drive straight. Half a second in which both turned differently by more than 0.1 rad (stamps 0.1 s apart at
/// 1 rad/s) and four standard deviations is a slip: the gyro alone is believed. Where the gyro told the same
/// reading ten times and more, it is stuck: the odometry is believed from the first of them on.
///
/// O(1), allocates nothing.
class Gyro {
 public:
  /// A step of the odometry, and whether readings of it cover that time.
  struct Step {
    Stamp from;
    Stamp to;
    bool is_measured = true;
  };

  Gyro(ArcModel arc, Duration max_hold);

  /// The next reading, at the end of the last step.
  void add(Stamp stamp, YawRate rate);

  /// The motion of a step that has no reading inside, with the heading held. `next` is the first reading at
  /// or after its end, if it has arrived.
  [[nodiscard]] Motion hold_heading(const Motion& odometry, const Step& step, const Event* next);

  [[nodiscard]] GyroFindings findings() const;

 private:
  /// What both tell of the same time.
  struct Turns {
    double gyro_rad = 0.0;  // with its bias
    double odometry_rad = 0.0;
    double odometry_var_rad2 = 0.0;
    double moved_m = 0.0;
    double duration_s = 0.0;

    Turns& operator+=(const Turns& more);
    [[nodiscard]] bool stands() const;
  };
  /// Sums over half seconds in which the robot did not stand.
  struct Trial {
    double turned_rad = 0.0;  // the odometry
    double products_rad2 = 0.0;
    double squares_rad2 = 0.0;
    Turns alone;  // where the gyro turned and the odometry did not
    double alone_rad = 0.0;
  };

  [[nodiscard]] double unbiased(const Turns& turns) const;
  [[nodiscard]] double apart(const Turns& turns) const;
  [[nodiscard]] double variance(const Turns& turns) const;
  [[nodiscard]] bool is_turned(const Turns& turns) const;
  [[nodiscard]] double step_variance(double dt_s) const;
  [[nodiscard]] bool contradict(const Turns& turns) const;
  [[nodiscard]] double gain_of(const Turns& turns) const;
  [[nodiscard]] Motion held(const Motion& odometry, const Turns& turns, double gain);
  void notice_stuck(Stamp stamp);
  void close_window(Stamp stamp);
  void put_on_trial(const Turns& turns);
  void believe(double factor);
  void learn_standing(const Turns& turns);
  void learn(const Turns& turns);
  void learn_noise(Stamp stamp, double change_radps);

  ArcModel arc_;
  YawRateTrack track_;
  GyroFindings findings_;
  std::optional<Stamp> last_stamp_;
  double last_radps_ = 0.0;  // as told

  Turns window_;       // the half second that is going on
  Turns last_window_;  // the one before
  int stood_ = 1;      // windows in a row in which the robot stood; it may have before the first
  bool slips_ = false;
  Trial trial_;

  double bias_radps_ = 0.0;
  double bias_var_;  // when it was learnt
  double since_learnt_s_ = 0.0;
  double noise_rad2_per_s_;
  int noise_readings_ = 0;

  int repeats_ = 0;  // readings equal to the one before them, in a row
  Turns since_change_;
  double held_rad_ = 0.0;  // beyond the odometry's turn, since then
  bool is_stuck_ = false;
  double owed_rad_ = 0.0;  // turn to be made up for
};

}  // namespace waymark
