#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "waymark/association/gate.hpp"
#include "waymark/association/landmark_table.hpp"
#include "waymark/association/local_map.hpp"
#include "waymark/association/recovery.hpp"
#include "waymark/core/filter.hpp"
#include "waymark/core/map_state.hpp"
#include "waymark/core/motion.hpp"
#include "waymark/models/landmark_sensor.hpp"

namespace waymark {

/// Whose fault it is when observations of landmarks of known identity are gated (fault detection and
/// isolation). One gated observation is an outlier. Consecutive ones of a landmark that agree with each
/// other, by odometry, are a fact:
/// * While observations of other landmarks are accepted it is the landmark's: its first observation was
/// false, it
///   was carried elsewhere, or two bear one identity. It has to begin anew where it is seen.
/// * When those of several landmarks are gated and none is accepted it is the robot's: it slipped, or was
/// carried.
///   If what it sees is arranged as in the map, it is where the map says.
///
/// A landmark that was observed once proves nothing: two observations that agree with each other outweigh it.
/// Landmarks that are younger than a contradiction, and were observed since with none that is older, prove
/// nothing either: a lost robot added them. docs/fault-isolation.md derives the counts.
///
/// Memory is taken at construction but for the names of landmarks that are found wrong.
class FaultIsolation {
 public:
  explicit FaultIsolation(const LandmarkSensor& sensor);

  /// The robot moves on. O(landmarks in doubt).
  void predict(const Motion& motion);

  /// Takes in what became of the observations of one scan, after gating and before the update; once a scan,
  /// before what else is asked. What passes the gate after others of its landmark did not is gated here if it
  /// is none of the likeliest 99 %.
  void review(std::span<const Observation> observations, std::span<Innovation> innovations,
              const LandmarkTable& table);

  /// More landmarks contradict the robot's pose than support it.
  [[nodiscard]] bool is_robot_lost() const { return lost_; }
  /// Whether it is time to look for the robot in its map: it is lost, and more is known than at the last
  /// time.
  [[nodiscard]] bool wants_relocation();
  /// Makes the robot's pose fit what contradicts it, by motions that `move(motion)` has the filter predict
  /// before it gates again what was gated: the one that takes it to where the landmarks are arranged as in
  /// the map, if that is clear; where observations have no place, growing ones without direction until the
  /// scan is accepted (inflate_until_accepted()). `innovations` are those that `move` changes. Allocates.
  template <class Move>
  void relocate(const MapState& map, const Pose2& T_world_robot, std::span<const Innovation> innovations,
                const Move& move) {
    if (slipped_) return inflate_until_accepted(innovations, move, kSlipInflations);
    const auto motion = find_motion(map, T_world_robot);
    if (!motion && knows_places()) return;
    if (motion)
      move(*motion);
    else
      inflate_until_accepted(innovations, move);
    begin_anew();
  }

  /// The motion that takes the robot from where it is believed to be to where the landmarks that contradict
  /// that are arranged as in the map, with a covariance. Nothing where that is not clear. Allocates.
  [[nodiscard]] std::optional<Motion> find_motion(const MapState& map, const Pose2& T_world_robot) const;

  /// Whether the gated observation at `index` of the last review proves that its landmark is not where the
  /// map has it.
  [[nodiscard]] bool is_landmark_wrong(std::size_t index) const { return wrong_[index]; }

  /// Whether that happened to a landmark that had begun anew before: it exists twice, or moves. It is to be
  /// dropped.
  [[nodiscard]] bool is_distrusted(LandmarkId id) const;

  /// What was found out so far, in numbers.
  [[nodiscard]] FilterHealth health() const;

  /// Landmarks that began anew because the only observation before was false.
  [[nodiscard]] int false_firsts() const { return false_firsts_; }
  /// Landmarks that were found elsewhere.
  [[nodiscard]] std::span<const LandmarkId> carried() const { return carried_; }
  /// Those of them that were found elsewhere again.
  [[nodiscard]] std::span<const LandmarkId> distrusted() const { return distrusted_; }

 private:
  static constexpr int kSlipInflations = 4;

  /// Consecutive gated observations of one landmark that agree; the last of them is in the local map.
  struct Contradiction {
    LandmarkId id;
    int observations = 1;
    int in_a_row = 1;                   ///< that were gated, whether they agree or not
    std::int64_t began_at_support = 0;  ///< value of support_ then
    std::int64_t reviewed_at = 0;       ///< the last review that saw it
    double expected_m2 = 0.0;           ///< ellipse in which the landmark was expected: product of its sigmas
    double began_at_m = 0.0;            ///< distance travelled then
    bool once = false;                  ///< the landmark was observed once
    bool placed = false;                ///< they were seen at a place, so that agreeing means something
  };

  /// A landmark whose observations were accepted: the last of them, as a value of support_.
  struct Supporter {
    LandmarkId id;
    std::int64_t supported_at = 0;
  };

  [[nodiscard]] bool is_accepted_too_late(const Innovation& innovation) const;
  [[nodiscard]] bool is_supported() const;
  [[nodiscard]] int supporters_since(std::int64_t support) const;
  [[nodiscard]] int contradicting_others(const Contradiction& contradiction) const;
  Contradiction& contradict(LandmarkId id, const Observation& observation);
  void support(LandmarkId id, bool is_connected);
  void blame(const Contradiction& contradiction);
  [[nodiscard]] bool may_be_wrong(const Contradiction& contradiction, int landmarks) const;
  void forget(LandmarkId id);
  [[nodiscard]] bool is_outweighed(const Contradiction& contradiction) const;
  [[nodiscard]] bool speaks_of_the_robot(const Contradiction& contradiction) const;
  [[nodiscard]] bool judge_slip(std::span<const Innovation> innovations) const;
  [[nodiscard]] bool judge_robot(std::span<const Innovation> innovations);
  [[nodiscard]] std::vector<ObservedLandmark> contradicting() const;
  [[nodiscard]] bool knows_places() const;
  void begin_anew();

  double independent_m_;  // way after which errors of observations are others
  Gate late_gate_;
  LocalMap doubted_;
  double travelled_m_ = 0.0;
  std::vector<Contradiction> contradictions_;
  std::vector<Supporter> supporters_;  // the latest kMaxSupporters
  std::vector<std::uint8_t> wrong_;    // by observation of the scan
  std::int64_t reviews_ = 0;
  std::int64_t support_ = 0;  // accepted observations of landmarks that are connected
  bool lost_ = false;
  bool slipped_ = false;
  int contradicting_ = 0;  // observations that say that the robot is lost
  int asked_at_ = 0;       // value of that at the last relocation that was tried
  int recoveries_ = 0;
  int false_firsts_ = 0;
  std::vector<LandmarkId> carried_;
  std::vector<LandmarkId> distrusted_;
};

}  // namespace waymark
