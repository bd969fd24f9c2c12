#pragma once

#include <cstddef>
#include <cstdint>

/// Particles are SIMD lanes: one column of floats per quantity, entry i of each belongs to particle i.
/// Columns start on kAlignment bytes and are padded to whole multiples of kParticleLanes, which kernels may
/// fill.
///
/// Positions in columns are differences to an origin nearby that the caller keeps in double precision, so
/// that a float resolves 2^-24 of a distance, however far from the world's origin: 6 um at 100 m.
namespace waymark::kernels {

inline constexpr std::size_t kParticleLanes = 16;

constexpr std::size_t round_up_particles(std::size_t count) {
  return (count + kParticleLanes - 1) / kParticleLanes * kParticleLanes;
}

/// Poses: position, and the heading as cosine and sine, so that no observation needs trigonometry.
struct PoseColumns {
  float* x = nullptr;
  float* y = nullptr;
  float* cos = nullptr;
  float* sin = nullptr;
};

/// How each robot's motion differed from the expected one: it moved by s * d, with d the increment that all
/// expected and s a Gaussian in (x, y, theta), in the frame that the robot had before. A robot that did not
/// know its heading from the start swings about that start: what is a banana in the place where it ends is a
/// Gaussian in s.
struct IncrementColumns {
  float* x = nullptr;
  float* y = nullptr;
  float* t = nullptr;
  float* xx = nullptr;
  float* xy = nullptr;
  float* xt = nullptr;
  float* yy = nullptr;
  float* yt = nullptr;
  float* tt = nullptr;
};

/// The expected increment d and the covariance of s, the same for all particles before anything is seen.
struct Increment {
  float x = 0.0F;
  float y = 0.0F;
  float t = 0.0F;
  float xx = 0.0F;
  float xy = 0.0F;
  float xt = 0.0F;
  float yy = 0.0F;
  float yt = 0.0F;
  float tt = 0.0F;
};

/// What the two numbers of a landmark are.
enum class LandmarkForm : std::uint8_t {
  kPoint,  ///< (x, y)
  kRay,    ///< (phi, rho): seen from its anchor in direction phi, at the inverse distance rho
  kRing    ///< (phi, r): seen from its anchor at distance r, in one of several directions phi
};

/// A landmark's two numbers as each particle knows them: mean (a, b) and covariance.
struct GaussianColumns {
  float* a = nullptr;
  float* b = nullptr;
  float* aa = nullptr;
  float* ab = nullptr;
  float* bb = nullptr;
};

/// One hypothesis about a landmark. Log weights are normalised over the hypotheses of a particle, and
/// kDeadMode where it has dropped this one.
struct LandmarkMode {
  GaussianColumns gaussian;
  float* log_weight = nullptr;  ///< null for the only hypothesis
};

inline constexpr float kDeadMode = -1e30F;
inline constexpr std::size_t kMaxModes = 32;

/// A landmark of all particles. Anchors are where each particle's sensor stood at the first observation.
struct LandmarkView {
  LandmarkForm form = LandmarkForm::kPoint;
  float offset_x = 0.0F;  ///< the landmark's origin, seen from that of the poses
  float offset_y = 0.0F;
  float* anchor_x = nullptr;
  float* anchor_y = nullptr;
  const LandmarkMode* modes = nullptr;
  std::size_t mode_count = 1;
};

enum class ObservationKind : std::uint8_t {
  kRangeBearing,
  kRange,
  kBearing,
  kViewEdge  ///< on an edge of the field of view, the nearer one: where it comes into view or leaves it
};

/// What each particle holds of the errors that all ranges have in common: the range is (measured - offset) *
/// factor. Null: none.
struct RangeErrors {
  const float* offset = nullptr;  ///< m
  const float* factor = nullptr;  ///< one over the scale
};

/// What was seen, and how unsure that is; but for errors of range the same for every particle.
struct LandmarkMeasurement {
  ObservationKind kind = ObservationKind::kRangeBearing;
  float range = 0.0F;
  float cos_bearing = 1.0F;  ///< direction in the robot frame, the sensor's yaw included
  float sin_bearing = 0.0F;
  float R_rr = 0.0F;
  float R_rb = 0.0F;
  float R_bb = 0.0F;
  RangeErrors range_errors;
};

/// Where the sensor sits on the robot and what it can see.
struct SensorMount {
  float x = 0.0F;
  float y = 0.0F;
  float cos_yaw = 1.0F;
  float sin_yaw = 0.0F;
  float half_view = 4.0F;  ///< half the field of view, rad; pi or more: it sees all round
  float min_rho = 1e-4F;   ///< one over the largest range, 1/m
  float min_range = 0.0F;

  bool operator==(const SensorMount&) const = default;
};

/// Nearer to the sensor than this the direction of a landmark means nothing, m.
inline constexpr float kNearest = 1e-3F;

/// Of the variance that a pivot of a Cholesky factor began with, what rounding can leave of one that is 0.
inline constexpr float kRelativePivot = 1e-6F;

}  // namespace waymark::kernels
