#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "waymark/association/local_map.hpp"
#include "waymark/core/motion.hpp"
#include "waymark/core/observation.hpp"
#include "waymark/models/landmark_sensor.hpp"

namespace waymark {

/// Consecutive gated observations of one landmark that agree with each other, by odometry.
struct Contradiction {
  LandmarkId id;
  int observations = 1;
  int in_a_row = 1;                   ///< that were gated, whether they agree or not
  std::int64_t began_at_support = 0;  ///< accepted observations until then
  double began_at_m = 0.0;            ///< distance travelled until then
  bool placed = false;                ///< they were seen at a place, so that agreeing means something
  bool once = false;                  ///< the landmark was observed once
};

/// What contradicts the robot's pose, and what has supported it meanwhile. At most LocalMap::kCapacity
/// landmarks contradict; one more takes the place of the oldest. Memory is taken at construction.
class Contradictions {
 public:
  explicit Contradictions(const LandmarkSensor& sensor);

  /// The robot moves on. O(landmarks that contradict).
  void predict(const Motion& motion);

  /// An observation of a landmark was gated: it goes on with the contradiction of that landmark, or begins
  /// one.
  Contradiction& contradict(LandmarkId id, const Observation& observation);
  /// An observation was accepted, which ends the contradiction of its landmark: the gated ones before were
  /// outliers. It supports the pose if the landmark is connected with the map.
  void support(LandmarkId id, bool is_connected);
  void forget(LandmarkId id);
  /// The pose is another: nothing contradicts or supports it yet.
  void clear();

  [[nodiscard]] std::span<const Contradiction> all() const { return contradictions_; }
  /// nullptr: nothing.
  [[nodiscard]] const Contradiction* find(LandmarkId id) const;
  /// Where its landmark was last seen, robot frame; nullptr where observations have no place.
  [[nodiscard]] const ObservedLandmark* seen(const Contradiction& contradiction) const {
    return seen_.find(contradiction.id);
  }

  /// Accepted observations since it began, and of how many landmarks they were (the latest 16 count).
  [[nodiscard]] std::int64_t support_since(const Contradiction& contradiction) const {
    return support_ - contradiction.began_at_support;
  }
  [[nodiscard]] int supporters_since(const Contradiction& contradiction) const;
  [[nodiscard]] double travelled_since_m(const Contradiction& contradiction) const {
    return travelled_m_ - contradiction.began_at_m;
  }

 private:
  /// A landmark whose observations were accepted: the last of them, as a value of support_.
  struct Supporter {
    LandmarkId id;
    std::int64_t supported_at = 0;
  };

  LocalMap seen_;
  std::vector<Contradiction> contradictions_;
  std::vector<Supporter> supporters_;
  std::int64_t support_ = 0;
  double travelled_m_ = 0.0;
};

}  // namespace waymark
