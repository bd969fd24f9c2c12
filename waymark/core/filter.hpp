#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "waymark/core/map_state.hpp"
#include "waymark/core/motion.hpp"
#include "waymark/core/observation.hpp"
#include "waymark/core/result.hpp"
#include "waymark/core/sensor_bias.hpp"

namespace waymark {

class FunctionBlocks;

/// How one observation was used, or why it was not.
enum class Outcome : std::uint8_t {
  kMatched,       ///< updated the filter
  kAdded,         ///< became a new landmark
  kGated,         ///< too far from where its landmark was expected: a misread identity or a wild measurement
  kUnidentified,  ///< carries no identity, and this filter was told that identities are known
  kUnusable,    ///< not finite, out of the sensor's range, of a kind the filter cannot use, or S not positive
  kAmbiguous,   ///< without identity, and neither surely of a landmark nor surely of none
  kDuplicate,   ///< a second observation of one landmark in one scan
  kDeferred,    ///< kept until it can be told, with others, where its landmark is
  kMapFull,     ///< would have been a new landmark, but there is no room
  kNotInMap,    ///< of no landmark of a map that is held as it is
  kDistrusted,  ///< of a landmark that was found at several places: it moves, or two bear its identity
};

[[nodiscard]] const char* describe(Outcome outcome);

/// Comparison of one observation with its prediction.
struct Innovation {
  LandmarkId landmark;
  Outcome outcome = Outcome::kUnusable;
  int dof = 0;        ///< 0 where nothing was compared
  double nis = 0.0;   ///< nu^T S^-1 nu: chi-square with `dof` degrees of freedom if all is well
  double gate = 0.0;  ///< the NIS above which it is refused
  /// Of this observation before anything of its scan was used: -1/2 (NIS + log |2 pi S|), in m, rad and px.
  /// Where a filter that is lost then widens what it expects, `nis` is of the wider expectation, but not
  /// this.
  double log_density = 0.0;
};

/// Result of correct(). A view into the filter, valid until its next call.
struct Correction {
  std::span<const Innovation> innovations;  ///< one per observation, in their order
  std::span<const LandmarkId> removed;
  [[nodiscard]] int count(Outcome outcome) const;
};

/// Interface between the pipeline and a filter: one virtual call per step, everything within is concrete.
/// predict(), correct() and pose() neither allocate in a steady state nor throw.
class Filter {
 public:
  Filter() = default;
  Filter(const Filter&) = delete;
  Filter& operator=(const Filter&) = delete;
  virtual ~Filter() = default;

  virtual void predict(const Motion& motion) = 0;

  /// All observations were made at the pose that the last predict() reached, and carry their covariance.
  virtual const Correction& correct(std::span<const Observation> observations) = 0;

  /// Cheap: called after every step.
  [[nodiscard]] virtual PoseEstimate pose() const = 0;

  /// False while a filter that starts at an unknown place has not found it: pose() means nothing.
  [[nodiscard]] virtual bool knows_pose() const { return true; }

  /// Why it gave up, if it has: what it is given has nothing to do with the map that it started from.
  [[nodiscard]] virtual std::optional<Error> refusal() const { return std::nullopt; }

  /// The map with marginal covariances; allocates. The stamp is the caller's to fill in.
  [[nodiscard]] virtual Snapshot snapshot() const = 0;

  /// The belief with all its correlations; allocates. Stamp and provenance are the caller's to fill in.
  [[nodiscard]] virtual MapState save() const = 0;

  /// Where the time went, block by block.
  [[nodiscard]] virtual const FunctionBlocks& blocks() const = 0;

  /// What is always wrong with the sensors, where the filter estimates any of it.
  [[nodiscard]] virtual std::optional<CalibrationEstimate> calibration() const { return std::nullopt; }
};

}  // namespace waymark
