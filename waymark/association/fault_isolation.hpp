#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "waymark/association/contradictions.hpp"
#include "waymark/association/gate.hpp"
#include "waymark/association/landmark_table.hpp"
#include "waymark/association/recovery.hpp"
#include "waymark/core/filter.hpp"
#include "waymark/core/map_state.hpp"
#include "waymark/core/motion.hpp"
#include "waymark/models/landmark_sensor.hpp"

namespace waymark {

/// Whose fault it is when observations of landmarks of known identity are gated (fault detection and
/// isolation). One gated observation is an outlier. Consecutive ones of a landmark that agree with each
/// other, by odometry, are a Contradiction.
///
/// If observations of more other landmarks are accepted meanwhile than contradict, it is the landmark's: its
/// first observation was false, it was carried elsewhere, or two bear one identity. It has to begin anew
/// where it is seen. If more landmarks contradict the pose than support it, it is the robot's: it slipped,
/// was carried, or closed a loop by a landmark that was. If what it sees is arranged as in the map, it is
/// where the map says.
///
/// A landmark that was observed once proves nothing: two observations that agree with each other outweigh it.
/// Landmarks that are younger than a contradiction, and were observed since with none that is older, prove
/// nothing either: a lost robot added them. docs/fault-isolation.md derives the counts.
///
/// Memory is taken at construction, but a little as scans grow and for the identities of landmarks that are
/// found wrong.
class FaultIsolation {
 public:
  explicit FaultIsolation(const LandmarkSensor& sensor);

  /// The robot moves on. O(landmarks in doubt).
  void predict(const Motion& motion) { contradictions_.predict(motion); }

  /// Takes in what became of the observations of one scan, after gating and before the update; once a scan,
  /// before what else is asked. What passes the gate after others of its landmark did not is gated here if it
  /// is none of the likeliest 99 %.
  void review(std::span<const Observation> observations, std::span<Innovation> innovations,
              const LandmarkTable& table);

  /// Whether it is time to make the pose fit: the robot is lost, and more is known than at the last time, or
  /// it seems to have slipped.
  [[nodiscard]] bool wants_relocation();
  /// Makes the robot's pose fit what contradicts it, by motions that `move(motion)` has the filter predict
  /// before it gates again all that was gated or accepted: the one that takes it to where the landmarks are
  /// arranged as in the map, which save() gives, if that is clear; where observations have no place, growing
  /// ones without direction until the scan is accepted (inflate_until_accepted()). `innovations` are those
  /// that `move` changes. Allocates.
  template <class Save, class Move>
  void relocate(const Save& save, const Pose2& T_world_robot, std::span<const Innovation> innovations,
                const Move& move) {
    if (slipped_) {
      ++slips_;
      return inflate_until_accepted(innovations, move, kSlipInflations);
    }
    const auto motion = find_motion(save(), T_world_robot);
    const bool has_places = std::ranges::any_of(contradictions_.all(), &Contradiction::placed);
    if (!motion && has_places) return;
    if (motion)
      move(*motion);
    else
      inflate_until_accepted(innovations, move);
    ++recoveries_;
    forget();
  }

  /// The motion that takes the robot from where it is believed to be to where the landmarks that contradict
  /// that are arranged as in the map, with a covariance. Nothing where that is not clear. Allocates.
  [[nodiscard]] std::optional<Motion> find_motion(const MapState& map, const Pose2& T_world_robot) const;

  /// The robot is somewhere else by now: nothing contradicts that pose yet.
  void forget();

  /// Whether the gated observation at `index` of the last review proves that its landmark is not where the
  /// map has it.
  [[nodiscard]] bool is_landmark_wrong(std::size_t index) const { return wrong_[index]; }

  /// Whether that happened to a landmark that had begun anew before: it exists twice, or moves. It is to be
  /// dropped.
  [[nodiscard]] bool is_distrusted(LandmarkId id) const;

  /// What was found out so far, in numbers.
  [[nodiscard]] FilterHealth health() const;

 private:
  static constexpr int kSlipInflations = 4;

  [[nodiscard]] bool is_accepted_too_late(const Innovation& innovation) const;
  [[nodiscard]] int other_landmarks_against(const Contradiction& contradiction) const;
  [[nodiscard]] bool is_outweighed(const Contradiction& contradiction) const;
  [[nodiscard]] bool may_be_carried(LandmarkId id, int landmarks) const;
  [[nodiscard]] bool speaks_of_the_robot(const Contradiction& contradiction) const;
  [[nodiscard]] bool may_be_a_slip(const Contradiction& contradiction, const Innovation& innovation) const;
  [[nodiscard]] bool judge_robot(std::span<const Innovation> innovations);
  void blame(const Contradiction& contradiction);

  double independent_m_;  // way after which errors of observations are others
  Gate late_gate_;
  Contradictions contradictions_;
  std::vector<std::uint8_t> wrong_;  // by observation of the scan
  bool lost_ = false;                // more landmarks contradict the pose than support it
  bool slipped_ = false;
  int contradicting_ = 0;  // observations that say that the robot is lost
  int asked_at_ = 0;       // value of that at the last relocation that was tried
  int slips_ = 0;
  int recoveries_ = 0;
  int false_firsts_ = 0;
  std::vector<LandmarkId> carried_;
  std::vector<LandmarkId> distrusted_;  // those that were again
};

}  // namespace waymark
