#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "waymark/core/event.hpp"

#include "workbench/logs/source.hpp"
#include "workbench/sim/drive.hpp"
#include "workbench/sim/options.hpp"

namespace waymark::sim {

/// The random streams of faults, apart from those of noise: a run with faults has the noise of its twin
/// without.
enum FaultStream : std::uint32_t {
  kCarriedRobot = 2,
  kCarriedLandmark = 3,
  kFalseFirst = 4,
  kFalse = 5,
  kTurnSlip = 6
};

/// A landmark that someone moves.
struct CarriedLandmark {
  std::size_t index = 0;
  Stamp at;
  Eigen::Vector2d to_m = Eigen::Vector2d::Zero();  ///< world
};

/// When the sensor looks for the i-th time.
[[nodiscard]] Stamp scan_stamp(const SensorOptions& options, std::uint64_t i);

/// Draws which landmark is carried and where to, among those that are in view a few times before and after.
/// Nothing where the options do not ask for it, or none is.
[[nodiscard]] std::optional<CarriedLandmark> carry_landmark(const FaultOptions& options,
                                                            const SensorOptions& sensor, const Drive& drive,
                                                            const std::vector<TrueLandmark>& landmarks,
                                                            std::uint64_t seed);

/// Where the landmarks are at that time.
[[nodiscard]] std::vector<TrueLandmark> places_at(std::vector<TrueLandmark> landmarks,
                                                  const std::optional<CarriedLandmark>& carried, Stamp when);

/// Makes observations of these scans false, as many as the options say: the first of some landmarks, and any.
/// With FaultOptions::omit it takes out what it would have made false, and what is seen of a landmark after
/// it was carried. Observations must have their identities.
void make_false(std::vector<Event>& scans, const FaultOptions& options,
                const std::optional<CarriedLandmark>& carried, const std::vector<TrueLandmark>& landmarks,
                std::uint64_t seed);

}  // namespace waymark::sim
