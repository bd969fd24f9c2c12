#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "waymark/association/landmark_table.hpp"
#include "waymark/association/local_map.hpp"
#include "waymark/core/filter.hpp"
#include "waymark/core/map_state.hpp"
#include "waymark/core/motion.hpp"
#include "waymark/models/landmark_sensor.hpp"

namespace waymark {

/// Whose fault it is when observations of named landmarks are gated (fault detection and isolation). One
/// gated observation is an outlier. Consecutive ones of a landmark that agree with each other, by odometry,
/// are a fact:
/// * While observations of other landmarks are accepted it is the landmark's: its first observation was
/// false, it
///   was carried elsewhere, or two bear one identity. It has to begin anew where it is seen.
/// * When those of several landmarks are gated and none is accepted it is the robot's: it slipped, or was
/// carried.
///   If what it sees is arranged as in the map, it is where the map says.
///
/// A landmark that was observed once proves nothing: two observations that agree with each other outweigh it.
/// Landmarks that are younger than a contradiction, and were observed since with none that is older, prove
/// nothing either: a lost robot added them. docs/robust.md derives the counts.
///
/// A landmark that was not seen for long is expected somewhere, not at a place: any observation of it passes
/// the gate, a false one too, and would turn the map with it. So it waits until another one stands as far
/// from it as in the map (corroborate()), or nothing else was seen for a while.
///
/// Memory is taken at construction but for the names of landmarks that are found wrong.
class FaultIsolation {
 public:
  /// From one landmark of a map to another: mean and covariance, world frame.
  struct Apart {
    Eigen::Vector2d mean = Eigen::Vector2d::Zero();
    Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();
  };

  explicit FaultIsolation(const LandmarkSensor& sensor);

  /// The robot moves on. O(landmarks in doubt).
  void predict(const Motion& motion);

  /// Sets to Outcome::kUncorroborated what was accepted, of named landmarks, but has to wait. `apart(a, b)`
  /// gives Apart of two landmarks of the table. After gating, before review().
  template <class ApartOf>
  void corroborate(std::span<const Observation> observations, std::span<Innovation> innovations,
                   const LandmarkTable& table, const ApartOf& apart) {
    if (!wait(observations, innovations)) return;
    for (std::size_t i = 0; i < innovations.size(); ++i) {
      if (!is_waiting(innovations[i])) continue;
      bool corroborated = has_waited_long(innovations[i].landmark);
      for (const ObservedLandmark& other : waiting_.landmarks()) {
        const auto a = table.find(innovations[i].landmark);
        const auto b = table.find(*other.id);
        if (a && b && *a != *b)
          corroborated |= are_as_far_apart(innovations[i].landmark, *other.id, apart(*a, *b));
      }
      if (!corroborated) innovations[i].outcome = Outcome::kUncorroborated;
    }
  }

  /// Takes in what became of the observations of one scan, after gating and before the update. Once a scan,
  /// before what else is asked.
  void review(std::span<const Observation> observations, std::span<const Innovation> innovations,
              const LandmarkTable& table);

  /// Several landmarks contradict the robot's pose and none supports it.
  [[nodiscard]] bool is_robot_lost() const { return lost_; }
  /// Whether it is time to look for the robot in its map: it is lost, and more is known than at the last
  /// time.
  [[nodiscard]] bool wants_relocation();
  /// The motion that takes the robot from where it is believed to be to where the landmarks in doubt are
  /// arranged as in the map, with a covariance. Nothing where that is not clear. Allocates.
  [[nodiscard]] std::optional<Motion> find_motion(const MapState& map, const Pose2& T_world_robot) const;
  /// The robot's pose was made to fit.
  void relocated();

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
  /// Consecutive gated observations of one landmark that agree; the last of them is in the local map.
  struct Contradiction {
    LandmarkId id;
    int observations = 1;
    std::int64_t began_at_support = 0;  ///< value of support_ then
    bool once = false;                  ///< the landmark was observed once
    bool placed = false;                ///< they were seen at a place, so that agreeing means something
  };

  [[nodiscard]] bool wait(std::span<const Observation> observations, std::span<const Innovation> innovations);
  [[nodiscard]] bool is_waiting(const Innovation& innovation) const;
  [[nodiscard]] bool has_waited_long(LandmarkId id) const;
  [[nodiscard]] bool are_as_far_apart(LandmarkId first, LandmarkId second, const Apart& apart) const;

  Contradiction& contradict(LandmarkId id, const Observation& observation);
  void support(LandmarkId id, bool is_connected);
  void blame(const Contradiction& contradiction);
  void forget(LandmarkId id);
  [[nodiscard]] bool is_outweighed(const Contradiction& contradiction) const;
  [[nodiscard]] bool speaks_of_the_robot(const Contradiction& contradiction) const;
  [[nodiscard]] bool judge_robot(std::span<const Innovation> innovations);
  [[nodiscard]] std::vector<ObservedLandmark> contradicting() const;

  LocalMap doubted_;
  LocalMap waiting_;
  std::vector<double> waiting_since_m_;  // by landmark of that
  double travelled_m_ = 0.0;
  std::vector<Contradiction> contradictions_;
  std::vector<std::uint8_t> wrong_;  // by observation of the scan
  std::int64_t support_ = 0;         // accepted observations of landmarks that are connected
  bool lost_ = false;
  int contradicting_ = 0;  // observations that say that the robot is lost
  int asked_at_ = 0;       // value of that at the last relocation that was tried
  int false_firsts_ = 0;
  int relocations_ = 0;
  std::vector<LandmarkId> carried_;
  std::vector<LandmarkId> distrusted_;
};

}  // namespace waymark
