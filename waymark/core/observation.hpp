#pragma once

#include <compare>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <Eigen/Core>

namespace waymark {

/// Identity of a landmark: a family (kind of number) and a number. Robots observed by other robots have
/// identities, too, but are never landmarks, because they move.
struct LandmarkId {
  enum class Family : std::uint8_t { kNone, kMarker, kBarcode, kCorner, kRobot };

  Family family = Family::kNone;
  std::int32_t number = -1;

  friend auto operator<=>(const LandmarkId&, const LandmarkId&) = default;
};

[[nodiscard]] inline std::string to_string(LandmarkId id) { return std::to_string(id.number); }

/// Distance and direction from the sensor; bearing is counter-clockwise from the sensor's forward axis.
struct RangeBearing {
  double range_m = 0.0;
  double bearing_rad = 0.0;
};

struct Range {
  double range_m = 0.0;
};

struct Bearing {
  double bearing_rad = 0.0;
};

/// Image position, origin at the centre of the first pixel, u right, v down.
struct Pixel {
  double u_px = 0.0;
  double v_px = 0.0;
};

using Measurement = std::variant<RangeBearing, Range, Bearing, Pixel>;

/// One observation of one landmark.
struct Observation {
  std::optional<LandmarkId> id;  ///< empty: the sensor cannot tell who it saw
  Measurement value;
  /// In the order and units of `value` (m, rad, px); one-dimensional values use (0, 0).
  /// Empty: the sensor did not say, and its configured noise applies.
  std::optional<Eigen::Matrix2d> covariance;
};

/// What one scan or one image showed: all observations share one stamp.
using Observations = std::vector<Observation>;

}  // namespace waymark
