#include "waymark/fastslam/landmark_forms.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "waymark/core/angle.hpp"
#include "waymark/fastslam/narrow.hpp"
#include "waymark/fastslam/particle_step.hpp"

namespace waymark::fastslam {
namespace {

using kernels::kDeadMode;
using kernels::LandmarkForm;
using kernels::LandmarkMeasurement;
using kernels::LandmarkMode;
using kernels::LandmarkView;
using kernels::ObservationKind;

// The sum of Gaussians on a ring is flat to 0.3 % when each is so wide in units of their spacing.
constexpr double kRingOverlap = 0.6;
// Gaussians of this part of their depth, in steps of (1 + it) / (1 - it), cover a ray evenly (Sola et al.
// 2005).
constexpr double kDepthSigma = 0.2;
// Pieces of a ray are widened by so much, in variance, that their sum is smooth.
constexpr double kRayInflation = 3.0;
// Places on a ray or a ring that are asked whether the landmark can be there.
constexpr int kCells = 1024;
// Limits of range further apart than this are those of a sensor of which nobody said any.
constexpr double kMaxLimitedRatio = 100.0;
// What was measured may be wrong by so many standard deviations.
constexpr double kMargin = 3.0;
// No landmark is nearer than this to a sensor whose limits do not say.
constexpr double kMinRayDepth_m = 0.1;
// Particles of so little weight together do not hinder a landmark from changing its form.
constexpr double kExceptions = 0.01;
constexpr float kPointSigmaPhi_rad = 0.1F;
constexpr float kPointLinearity = 0.1F;
constexpr float kMergeDistanceSquared = 1.0F;

bool is_alive(const LandmarkMode& mode, std::size_t i) { return mode.log_weight[i] > 0.5F * kDeadMode; }

struct ModeNumbers {
  float a, b, aa, ab, bb;
};

ModeNumbers numbers(const LandmarkMode& mode, std::size_t i) {
  const auto& g = mode.gaussian;
  return {g.a[i], g.b[i], g.aa[i], g.ab[i], g.bb[i]};
}

void set_numbers(const LandmarkMode& mode, std::size_t i, const ModeNumbers& m) {
  const auto& g = mode.gaussian;
  g.a[i] = m.a;
  g.b[i] = m.b;
  g.aa[i] = m.aa;
  g.ab[i] = m.ab;
  g.bb[i] = m.bb;
}

float squared_distance(const ModeNumbers& m, const ModeNumbers& n) {
  const float da = n.a - m.a;
  const float db = n.b - m.b;
  const float aa = m.aa + n.aa;
  const float ab = m.ab + n.ab;
  const float bb = m.bb + n.bb;
  return (bb * da * da - 2.0F * ab * da * db + aa * db * db) / (aa * bb - ab * ab);
}

/// The second hypothesis of particle i goes into the first, with the moments of both.
void merge(const LandmarkMode& first, const LandmarkMode& second, std::size_t i) {
  const ModeNumbers m = numbers(first, i);
  const ModeNumbers n = numbers(second, i);
  const float difference = second.log_weight[i] - first.log_weight[i];
  const float part = 1.0F / (1.0F + std::exp(-difference));
  const float da = n.a - m.a;
  const float db = n.b - m.b;
  const float spread = part * (1.0F - part);
  set_numbers(
      first, i,
      {m.a + part * da, m.b + part * db, m.aa + part * (n.aa - m.aa) + spread * da * da,
       m.ab + part * (n.ab - m.ab) + spread * da * db, m.bb + part * (n.bb - m.bb) + spread * db * db});
  first.log_weight[i] -= std::log1p(-part);
  second.log_weight[i] = kDeadMode;
}

/// Hypotheses stand in the order of their directions, so those that meet are neighbours.
void merge_neighbours(const LandmarkView& landmark, std::size_t begin, std::size_t end) {
  for (std::size_t k = 0; k + 1 < landmark.mode_count; ++k) {
    const LandmarkMode& first = landmark.modes[k];
    const LandmarkMode& second = landmark.modes[k + 1];
    for (std::size_t i = begin; i < end; ++i)
      if (is_alive(first, i) && is_alive(second, i) &&
          squared_distance(numbers(first, i), numbers(second, i)) < kMergeDistanceSquared)
        merge(first, second, i);
  }
}

std::size_t best_mode(const LandmarkView& landmark, std::size_t i) {
  std::size_t best = 0;
  for (std::size_t k = 1; k < landmark.mode_count; ++k)
    if (landmark.modes[k].log_weight[i] > landmark.modes[best].log_weight[i]) best = k;
  return best;
}

bool has_several(const LandmarkView& landmark, std::size_t i) {
  int alive = 0;
  for (std::size_t k = 0; k < landmark.mode_count; ++k) alive += is_alive(landmark.modes[k], i) ? 1 : 0;
  return alive > 1;
}

void drop_dead_modes(LandmarkStore& store, int landmark, ParticleBlocks& blocks) {
  for (std::size_t k = store.modes(landmark); k-- > 0 && store.modes(landmark) > 1;) {
    const LandmarkMode& mode = store.view(landmark, {0.0, 0.0}).modes[k];
    const double best = blocks.largest([&](std::size_t begin, std::size_t end) {
      return static_cast<double>(*std::max_element(mode.log_weight + begin, mode.log_weight + end));
    });
    if (best < 0.5 * static_cast<double>(kDeadMode)) store.drop_mode(landmark, k);
  }
}

/// The weight of the particles for which `fails`.
template <class Fails>
double weight_of_exceptions(const Particles& particles, ParticleBlocks& blocks, const Fails& fails) {
  return blocks.sum([&](std::size_t begin, std::size_t end) {
    std::array<double, 1> sum{};
    for (std::size_t i = begin; i < end; ++i)
      if (fails(i)) sum[0] += particles.weights()[i];
    return sum;
  })[0];
}

void keep_best_modes(LandmarkStore& store, int landmark, ParticleBlocks& blocks) {
  const LandmarkView view = store.view(landmark, {0.0, 0.0});
  blocks.run([&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      set_numbers(view.modes[0], i, numbers(view.modes[best_mode(view, i)], i));
  });
  while (store.modes(landmark) > 1) store.drop_mode(landmark, store.modes(landmark) - 1);
}

/// p = anchor + d (cos phi, sin phi), d = 1 / rho or r, to first order.
ModeNumbers to_point(LandmarkForm form, const ModeNumbers& m, float anchor_x, float anchor_y) {
  const bool is_ray = form == LandmarkForm::kRay;
  const float d = is_ray ? 1.0F / m.b : m.b;
  const float d_b = is_ray ? -d * d : 1.0F;
  const float c = std::cos(m.a);
  const float s = std::sin(m.a);
  const float xa = -d * s;
  const float ya = d * c;
  const float xb = d_b * c;
  const float yb = d_b * s;
  return {anchor_x + d * c, anchor_y + d * s, xa * xa * m.aa + 2.0F * xa * xb * m.ab + xb * xb * m.bb,
          xa * ya * m.aa + (xa * yb + xb * ya) * m.ab + xb * yb * m.bb,
          ya * ya * m.aa + 2.0F * ya * yb * m.ab + yb * yb * m.bb};
}

/// L = 4 sigma_d |cos alpha| / d of a ray, seen from a sensor.
float linearity(const ModeNumbers& m, float anchor_x, float anchor_y, float sensor_x, float sensor_y) {
  const float depth = 1.0F / m.b;
  const float c = std::cos(m.a);
  const float s = std::sin(m.a);
  const float dx = anchor_x + depth * c - sensor_x;
  const float dy = anchor_y + depth * s - sensor_y;
  const float d_squared = dx * dx + dy * dy;
  return 4.0F * std::sqrt(m.bb) * depth * depth * std::abs(c * dx + s * dy) / d_squared;
}

bool is_linear_ring(const LandmarkStore& store, int landmark, const Particles& particles,
                    ParticleBlocks& blocks) {
  const float* variance = store.view(landmark, {0.0, 0.0}).modes[0].gaussian.aa;
  return weight_of_exceptions(particles, blocks, [&](std::size_t i) {
           return !(variance[i] < kPointSigmaPhi_rad * kPointSigmaPhi_rad);
         }) < kExceptions;
}

bool is_linear_ray(const LandmarkStore& store, int landmark, const Particles& particles,
                   const kernels::SensorMount& mount, ParticleBlocks& blocks) {
  const Eigen::Vector2d origin_m = particles.pose(0).position();
  const LandmarkView view = store.view(landmark, origin_m);
  const double exceptions = blocks.sum([&](std::size_t begin, std::size_t end) {
    BlockScratch scratch;
    const kernels::PoseColumns sensors =
        load_sensors(particles, mount, origin_m, {begin, end - begin}, scratch);
    std::array<double, 1> sum{};
    for (std::size_t i = begin; i < end; ++i) {
      const ModeNumbers m = numbers(view.modes[0], i);
      const float L = linearity(m, view.anchor_x[i] + view.offset_x, view.anchor_y[i] + view.offset_y,
                                sensors.x[i - begin], sensors.y[i - begin]);
      if (!(m.b > 0.0F) || !(L < kPointLinearity)) sum[0] += particles.weights()[i];
    }
    return sum;
  })[0];
  return exceptions < kExceptions;
}

/// Where it was seen, in the sensor's frame.
Eigen::Vector2d direction_of(const LandmarkMeasurement& seen, const LandmarkSensor& sensor) {
  return Pose2{0.0, 0.0, -to_radians(sensor.yaw_deg)} * Eigen::Vector2d(seen.cos_bearing, seen.sin_bearing);
}

/// What is likely of a number between two limits, by moments of pieces: each piece a hypothesis.
class Pieces {
 public:
  explicit Pieces(std::size_t count) : pieces_(count) {}

  void add(std::size_t piece, double value, double mass) {
    Piece& p = pieces_[std::min(piece, pieces_.size() - 1)];
    p.mass += mass;
    p.first += mass * value;
    p.second += mass * value * value;
  }

  /// Those of a part of the most likely one. `widening` is on a piece's own variance, `blur` is added.
  [[nodiscard]] FirstForm form(LandmarkForm form, double widening, double blur) const {
    FirstForm first{form, 0, {}};
    double most = 0.0;
    for (const Piece& p : pieces_) most = std::max(most, p.mass);
    double all = 0.0;
    for (const Piece& p : pieces_)
      if (p.mass > kMinPart * most) all += p.mass;
    for (const Piece& p : pieces_) {
      if (!(p.mass > kMinPart * most)) continue;
      const double mean = p.first / p.mass;
      const double variance = std::max(p.second / p.mass - mean * mean, 0.0);
      first.guess.modes[first.modes++] = {narrow(mean), narrow(widening * variance + blur),
                                          narrow(std::log(p.mass / all))};
    }
    return first;
  }

 private:
  static constexpr double kMinPart = 0.01;

  struct Piece {
    double mass = 0.0;
    double first = 0.0;
    double second = 0.0;
  };
  std::vector<Piece> pieces_;
};

/// Pieces of a ray in a geometric series of distances. Every distance between the limits is as likely; where
/// those are so far apart that they say nothing, every order of magnitude.
FirstForm first_ray(const LandmarkMeasurement& seen, const LandmarkSensor& sensor,
                    const ViewHistory& history) {
  constexpr double kRatio = (1.0 + kDepthSigma) / (1.0 - kDepthSigma);
  const double nearest_m = std::max(sensor.min_range_m, kMinRayDepth_m);
  const double farthest_m = std::max(sensor.max_range_m, 1.01 * nearest_m);
  const double decades = std::log(farthest_m / nearest_m);
  const bool is_limited = farthest_m / nearest_m < kMaxLimitedRatio;
  const double steps = std::ceil(decades / std::log(kRatio));
  const double count = std::clamp(steps, 1.0, static_cast<double>(kernels::kMaxModes));
  const Eigen::Vector2d direction = direction_of(seen, sensor);
  const ViewMargin margin{0.0, kMargin * std::sqrt(static_cast<double>(seen.R_bb))};
  Pieces pieces(static_cast<std::size_t>(count));
  double mean_depth_m = 0.0;
  double mass = 0.0;
  for (int k = 0; k < kCells; ++k) {
    const double part = (k + 0.5) / kCells;
    const double depth_m = nearest_m * std::exp(part * decades);
    const double likelihood =
        history.likelihood_unseen(depth_m * direction, margin) * (is_limited ? depth_m : 1.0);
    pieces.add(static_cast<std::size_t>(part * count), 1.0 / depth_m, likelihood);
    mean_depth_m += likelihood * depth_m;
    mass += likelihood;
  }
  mean_depth_m /= mass;
  // The step of the cells and the error of a range, as inverse distances.
  const double blur = std::hypot(sensor.range_sigma_m / mean_depth_m, decades / kCells) / mean_depth_m;
  return pieces.form(LandmarkForm::kRay, kRayInflation, blur * blur);
}

/// Pieces of the arc within the field of view, every direction as likely.
FirstForm first_ring(const LandmarkMeasurement& seen, const LandmarkSensor& sensor,
                     const ViewHistory& history) {
  const double view_rad = to_radians(std::clamp(sensor.field_of_view_deg, 1.0, 360.0));
  const double sigma_phi =
      std::sqrt(0.6 * std::sqrt(static_cast<double>(seen.R_rr)) / static_cast<double>(seen.range));
  const double wanted = std::ceil(kRingOverlap * view_rad / sigma_phi);
  const double count = std::clamp(wanted, 1.0, static_cast<double>(kernels::kMaxModes));
  const ViewMargin margin{kMargin * std::sqrt(static_cast<double>(seen.R_rr)), 0.0};
  Pieces pieces(static_cast<std::size_t>(count));
  for (int k = 0; k < kCells; ++k) {
    const double part = (k + 0.5) / kCells;
    const double phi = (part - 0.5) * view_rad;
    const Eigen::Vector2d p = static_cast<double>(seen.range) * Eigen::Vector2d(std::cos(phi), std::sin(phi));
    pieces.add(static_cast<std::size_t>(part * count), phi, history.likelihood_unseen(p, margin));
  }
  const double blur_rad = std::hypot(to_radians(sensor.bearing_sigma_deg), view_rad / kCells);
  // A piece that is evenly likely has the variance of its width over 12.
  return pieces.form(LandmarkForm::kRing, 12.0 * kRingOverlap * kRingOverlap, blur_rad * blur_rad);
}

}  // namespace

FirstForm first_form(const kernels::LandmarkMeasurement& seen, const LandmarkSensor& sensor,
                     const ViewHistory& history) {
  if (seen.kind == ObservationKind::kRangeBearing) return {};
  return seen.kind == ObservationKind::kBearing ? first_ray(seen, sensor, history)
                                                : first_ring(seen, sensor, history);
}

bool can_take(LandmarkForm form, ObservationKind kind) {
  return form == LandmarkForm::kPoint || (form == LandmarkForm::kRay && kind == ObservationKind::kBearing) ||
         (form == LandmarkForm::kRing &&
          (kind == ObservationKind::kRange || kind == ObservationKind::kViewEdge));
}

void tidy_modes(LandmarkStore& store, int landmark, const Particles& particles, ParticleBlocks& blocks) {
  if (store.modes(landmark) == 1) return;
  blocks.run([view = store.view(landmark, {0.0, 0.0})](std::size_t begin, std::size_t end) {
    merge_neighbours(view, begin, end);
  });
  drop_dead_modes(store, landmark, blocks);
  if (store.modes(landmark) == 1) return;
  const LandmarkView view = store.view(landmark, {0.0, 0.0});
  const double exceptions =
      weight_of_exceptions(particles, blocks, [&view](std::size_t i) { return has_several(view, i); });
  if (exceptions < kExceptions) keep_best_modes(store, landmark, blocks);
}

void become_point_if_linear(LandmarkStore& store, int landmark, const Particles& particles,
                            const kernels::SensorMount& mount, ParticleBlocks& blocks) {
  const LandmarkForm form = store.form(landmark);
  if (form == LandmarkForm::kPoint || store.modes(landmark) > 1) return;
  const bool is_linear = form == LandmarkForm::kRing
                             ? is_linear_ring(store, landmark, particles, blocks)
                             : is_linear_ray(store, landmark, particles, mount, blocks);
  if (!is_linear) return;
  const LandmarkView view = store.view(landmark, {0.0, 0.0});
  blocks.run([&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      set_numbers(view.modes[0], i,
                  to_point(form, numbers(view.modes[0], i), view.anchor_x[i], view.anchor_y[i]));
  });
  store.become_point(landmark);
}

}  // namespace waymark::fastslam
