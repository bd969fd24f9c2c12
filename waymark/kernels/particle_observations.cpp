#include "waymark/kernels/particle_observations.hpp"

#include <cmath>
#include <type_traits>

#include "waymark/kernels/highway_targets.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "waymark/kernels/particle_observations.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "waymark/kernels/particle_formulas-inl.h"

HWY_BEFORE_NAMESPACE();
namespace waymark::kernels::HWY_NAMESPACE {

// Hypotheses below this part of the best one are dropped: log 1e-3.
constexpr float kLogDrop = -6.9F;

// How sharp the limits of what a sensor sees are, besides what is unsure about the hypothesis: (2 deg)^2,
// (0.1 m)^2; how far outside a hypothesis dies that is seen, and how far inside one that is not.
constexpr float kViewEdgeVariance = 0.0012F;
constexpr float kReachVariance = 0.01F;
constexpr float kDeviationsOutside = 3.0F;
constexpr float kDeviationsInside = 2.0F;

constexpr double kTurn = 6.283185307179586;

#if HWY_TARGET == HWY_SCALAR
HWY_INLINE void add_scaled(Lanes x, double scale, double* sum) {
  *sum += scale * static_cast<double>(hn::GetLane(x.v));
}
#else
HWY_INLINE void add_scaled(Lanes x, double scale, double* sum) {
  const hn::ScalableTag<double> wide;
  const hn::Rebind<float, decltype(wide)> half;
  const auto factor = hn::Set(wide, scale);
  const auto lower = hn::PromoteTo(wide, hn::LowerHalf(half, x.v));
  const auto upper = hn::PromoteTo(wide, hn::UpperHalf(half, x.v));
  double* const rest = sum + hn::Lanes(wide);
  hn::Store(hn::MulAdd(factor, lower, hn::Load(wide, sum)), wide, sum);
  hn::Store(hn::MulAdd(factor, upper, hn::Load(wide, rest)), wide, rest);
}
#endif
HWY_INLINE void add_scaled(double x, double scale, double* sum) { *sum += scale * x; }

template <class T>
HWY_INLINE T load_weight(const double* weight, std::size_t i);
template <>
HWY_INLINE Lanes load_weight<Lanes>(const double* weight, std::size_t i) {
  alignas(64) float values[kParticleLanes];
  for (std::size_t k = 0; k < width_of<Lanes>(); ++k) values[k] = static_cast<float>(weight[i + k]);
  return load<Lanes>(values, 0);
}
template <>
HWY_INLINE double load_weight<double>(const double* weight, std::size_t i) {
  return weight[i];
}

// The same angle within half a turn of 0.
HWY_INLINE Lanes wrapped(Lanes angle) {
  const Lanes turns = hn::Round((angle * (1.0 / kTurn)).v);
  return angle - turns * kTurn;
}
HWY_INLINE double wrapped(double angle) { return angle - kTurn * std::rint(angle / kTurn); }

template <class T>
HWY_INLINE T anchor_x(const LandmarkView& landmark, std::size_t i) {
  return load<T>(landmark.anchor_x, i) + T(landmark.offset_x);
}
template <class T>
HWY_INLINE T anchor_y(const LandmarkView& landmark, std::size_t i) {
  return load<T>(landmark.anchor_y, i) + T(landmark.offset_y);
}

// The observation models of a landmark of one hypothesis. Each is a type, so that loops over particles do not
// choose.
struct AtPoint {
  template <class T>
  static HWY_INLINE Measured2<T> measure(const LandmarkObservation& s, const Sensor<T>& from,
                                         const Gaussian2<T>& m, std::size_t i) {
    return measure_point(s.seen, range_of<T>(s.seen, i), from, m, T(s.landmark.offset_x),
                         T(s.landmark.offset_y));
  }
};
struct RangeOfPoint {
  template <class T>
  static HWY_INLINE Measured1<T> measure(const LandmarkObservation& s, const Sensor<T>& from,
                                         const Gaussian2<T>& m, std::size_t i) {
    return measure_range(s.seen, range_of<T>(s.seen, i), from, m, T(s.landmark.offset_x),
                         T(s.landmark.offset_y));
  }
};
struct BearingOfPoint {
  template <class T>
  static HWY_INLINE Measured1<T> measure(const LandmarkObservation& s, const Sensor<T>& from,
                                         const Gaussian2<T>& m, std::size_t) {
    return measure_bearing(s.seen, from, m, T(s.landmark.offset_x), T(s.landmark.offset_y));
  }
};
struct BearingOfRay {
  template <class T>
  static HWY_INLINE Measured1<T> measure(const LandmarkObservation& s, const Sensor<T>& from,
                                         const Gaussian2<T>& m, std::size_t i) {
    return measure_ray(s.seen, from, m, anchor_x<T>(s.landmark, i), anchor_y<T>(s.landmark, i));
  }
};
struct RangeOfRing {
  template <class T>
  static HWY_INLINE Measured1<T> measure(const LandmarkObservation& s, const Sensor<T>& from,
                                         const Gaussian2<T>& m, std::size_t i) {
    return measure_ring(s.seen, range_of<T>(s.seen, i), from, m, anchor_x<T>(s.landmark, i),
                        anchor_y<T>(s.landmark, i))
        .measured;
  }
};

// The derivatives of the edge's innovation are those of a bearing.
struct EdgeOfPoint {
  template <class T>
  static HWY_INLINE Measured1<T> measure(const LandmarkObservation& s, const Sensor<T>& from,
                                         const Gaussian2<T>& m, std::size_t) {
    const T ox = T(s.landmark.offset_x);
    const T oy = T(s.landmark.offset_y);
    Measured1<T> measured = measure_bearing(s.seen, from, m, ox, oy);
    measured.nu = edge_innovation(s.mount, from, ray_of(m.a + ox - from.x, m.b + oy - from.y));
    return measured;
  }
};
struct EdgeOfRing {
  template <class T>
  static HWY_INLINE Measured1<T> measure(const LandmarkObservation& s, const Sensor<T>& from,
                                         const Gaussian2<T>& m, std::size_t i) {
    return measure_edge(s.seen, s.mount, from, m, anchor_x<T>(s.landmark, i), anchor_y<T>(s.landmark, i));
  }
};

// Calls job(model) with the model of such an observation of such a landmark.
template <class Job>
HWY_INLINE auto dispatch_model(const LandmarkObservation& s, const Job& job) {
  if (s.landmark.form == LandmarkForm::kRay) return job(BearingOfRay());
  if (s.landmark.form == LandmarkForm::kRing)
    return s.seen.kind == ObservationKind::kViewEdge ? job(EdgeOfRing()) : job(RangeOfRing());
  if (s.seen.kind == ObservationKind::kViewEdge) return job(EdgeOfPoint());
  if (s.seen.kind == ObservationKind::kRange) return job(RangeOfPoint());
  if (s.seen.kind == ObservationKind::kBearing) return job(BearingOfPoint());
  return job(AtPoint());
}

template <class T>
HWY_INLINE Updated<T> update(const Measured2<T>& measured, const Gaussian2<T>& m) {
  return update2(measured, m);
}
template <class T>
HWY_INLINE Updated<T> update(const Measured1<T>& measured, const Gaussian2<T>& m) {
  return update1(measured, m);
}

// What a landmark cannot be is not kept: a ray does not reach beyond the sensor's range, let alone infinity.
template <class T, class Model>
HWY_INLINE Gaussian2<T> possible(const LandmarkObservation&, const Gaussian2<T>& m, Model) {
  return m;
}
template <class T>
HWY_INLINE Gaussian2<T> possible(const LandmarkObservation& s, const Gaussian2<T>& m, BearingOfRay) {
  const T rho = larger(m.b, T(s.mount.min_rho));
  const T shift = rho - m.b;
  return {m.a, rho, m.aa, m.ab, m.bb + shift * shift};
}

template <class T>
HWY_INLINE Conditioned<T> condition(const Measured2<T>& measured, const Sensor<T>& from,
                                    const Pose<T>& before, const Gaussian3<T>& d, const Gaussian2<T>& m) {
  return condition2(d, rows_of(measured, from, before), measured, m);
}
template <class T>
HWY_INLINE Conditioned<T> condition(const Measured1<T>& measured, const Sensor<T>&, const Pose<T>& before,
                                    const Gaussian3<T>& d, const Gaussian2<T>& m) {
  return condition1(d, in_frame_of(before, measured.g_x, measured.g_y, measured.g_t), measured.nu,
                    landmark_variance(measured, m) + measured.R);
}

// nu (r, b) and L (rr, rb, bb), in the units of the measurement.
template <class T>
struct Compared {
  T nu_r, nu_b, rr, rb, bb;
};

template <class T>
HWY_INLINE Compared<T> compare(const Measured2<T>& l, const Sensor<T>& from, const Pose<T>& before,
                               const Gaussian3<T>& d, const Gaussian2<T>& m, ObservationKind) {
  const Rows2<T> g = rows_of(l, from, before);
  const RayCovariance<T> L = innovation_covariance(l, m, g, times(d, g.a), times(d, g.t));
  const T inverse_r = l.ray.inverse_r;
  return {l.nu_a, l.nu_t * inverse_r, L.aa, L.at * inverse_r, L.tt * inverse_r * inverse_r};
}
template <class T>
HWY_INLINE Compared<T> compare(const Measured1<T>& l, const Sensor<T>&, const Pose<T>& before,
                               const Gaussian3<T>& d, const Gaussian2<T>& m, ObservationKind kind) {
  const Column3<T> g = in_frame_of(before, l.g_x, l.g_y, l.g_t);
  const T L = dot(g, times(d, g)) + landmark_variance(l, m) + l.R;
  const T zero = T(0.0F);
  if (kind == ObservationKind::kRange) return {l.nu, zero, L, zero, zero};
  return {zero, l.nu, zero, zero, L};
}

// Sums of lanes; a particle or a hypothesis without weight adds nothing, whatever its numbers are.
constexpr int kTerms = 9;

template <class T>
struct Sums {
  T terms[kTerms];

  HWY_INLINE void add(const Compared<T>& c, T nu_r, T nu_b, T weight) {
    const T values[kTerms] = {T(1.0F), nu_r, nu_b, nu_r * nu_r, nu_r * nu_b, nu_b * nu_b, c.rr, c.rb, c.bb};
    for (int k = 0; k < kTerms; ++k)
      terms[k] = terms[k] + where_less(T(0.0F), weight, weight * values[k], T(0.0F));
  }
  [[nodiscard]] HWY_INLINE InnovationSums total() const {
    const auto term = [this](int k) HWY_ATTR { return sum_of(terms[k]); };
    return {term(0), {term(1), term(2)}, {term(3), term(4), term(5)}, {term(6), term(7), term(8)}};
  }
};

template <class T, class Model>
HWY_INLINE InnovationSums compare_range(const LandmarkObservation& observation, const Increment& increment,
                                        const PoseColumns& before, const About& about, const double* weight,
                                        ParticleRange range) {
  const LandmarkObservation s = carried(observation, increment);
  const T zero = T(0.0F);
  const auto d = unseen<T>(increment);
  Sums<T> sums{{zero, zero, zero, zero, zero, zero, zero, zero, zero}};
  for (std::size_t i = 0; i < range.count; i += width_of<T>()) {
    const Pose<T> pose = load_pose<T>(before, i);
    const Sensor<T> from = sensor_of(pose, s.mount);
    const T w = load_weight<T>(weight, i);
    for (std::size_t k = 0; k < s.landmark.mode_count; ++k) {
      const LandmarkMode& mode = s.landmark.modes[k];
      const Gaussian2<T> m = load_gaussian<T>(mode.gaussian, range.begin + i);
      const T part =
          s.landmark.mode_count == 1 ? w : w * exponential(load<T>(mode.log_weight, range.begin + i));
      const Compared<T> c =
          compare(Model::measure(s, from, m, range.begin + i), from, pose, d, m, s.seen.kind);
      sums.add(c, c.nu_r - T(about.range), wrapped(c.nu_b - T(about.bearing)), part);
    }
  }
  return sums.total();
}

template <class T>
struct Polar {
  T range, bearing;
};

template <class T>
HWY_INLINE Polar<T> innovation(const Measured2<T>& l, ObservationKind) {
  return {l.nu_a, l.nu_t * l.ray.inverse_r};
}
template <class T>
HWY_INLINE Polar<T> innovation(const Measured1<T>& l, ObservationKind kind) {
  const T zero = T(0.0F);
  if (kind == ObservationKind::kRange) return {l.nu, zero};
  return {zero, l.nu};
}

template <class T, class Model>
HWY_INLINE void list_range(const LandmarkObservation& observation, const Increment& increment,
                           const PoseColumns& before, const About& about, float* nu_r, float* nu_b,
                           ParticleRange range) {
  const LandmarkObservation s = carried(observation, increment);
  for (std::size_t i = 0; i < range.count; i += width_of<T>()) {
    const Sensor<T> from = sensor_of(load_pose<T>(before, i), s.mount);
    const T zero = T(0.0F);
    Polar<T> mean{zero, zero};
    for (std::size_t k = 0; k < s.landmark.mode_count; ++k) {
      const LandmarkMode& mode = s.landmark.modes[k];
      const Gaussian2<T> m = load_gaussian<T>(mode.gaussian, range.begin + i);
      const Polar<T> nu = innovation(Model::measure(s, from, m, range.begin + i), s.seen.kind);
      const T of_range = nu.range - T(about.range);
      const T of_bearing = wrapped(nu.bearing - T(about.bearing));
      if (s.landmark.mode_count == 1) {
        mean = {of_range, of_bearing};
        continue;
      }
      const T log_weight = load<T>(mode.log_weight, range.begin + i);
      const T w = exponential(log_weight);
      mean.range = mean.range + where_less(T(kLogDrop), log_weight, w * of_range, zero);
      mean.bearing = mean.bearing + where_less(T(kLogDrop), log_weight, w * of_bearing, zero);
    }
    store(mean.range, nu_r, i);
    store(mean.bearing, nu_b, i);
  }
}

// Several hypotheses together say of the increment what their mixture has as moments: with g_k the row of
// each, cov(d, z) = P sum w_k g_k, var z = sum w_k (g_k P g_k^T + Z_k + nu_k^2) - (sum w_k nu_k)^2.
template <class T, class Model>
HWY_INLINE Conditioned<T> condition_by_modes(const LandmarkObservation& s, const Sensor<T>& from,
                                             const Pose<T>& before, const Gaussian3<T>& d, std::size_t i,
                                             Model) {
  const T zero = T(0.0F);
  T nu = zero;
  T second = zero;
  Column3<T> g{zero, zero, zero};
  for (std::size_t k = 0; k < s.landmark.mode_count; ++k) {
    const LandmarkMode& mode = s.landmark.modes[k];
    const Gaussian2<T> m = load_gaussian<T>(mode.gaussian, i);
    const Measured1<T> measured = Model::measure(s, from, m, i);
    const Column3<T> g_k = in_frame_of(before, measured.g_x, measured.g_y, measured.g_t);
    const T log_weight = load<T>(mode.log_weight, i);
    const T w = exponential(log_weight);
    const auto add = [&](T& to, T x) HWY_ATTR { to = to + where_less(T(kLogDrop), log_weight, w * x, zero); };
    add(nu, measured.nu);
    add(second,
        measured.nu * measured.nu + dot(g_k, times(d, g_k)) + landmark_variance(measured, m) + measured.R);
    add(g.x, g_k.x);
    add(g.y, g_k.y);
    add(g.t, g_k.t);
  }
  // No less than the noise, not by rounding and not where every hypothesis is dropped.
  const T noise = T(s.seen.kind == ObservationKind::kRange ? s.seen.R_rr : s.seen.R_bb);
  return condition1(d, g, nu, larger(second - nu * nu - dot(g, times(d, g)), noise));
}
template <class T>
HWY_INLINE Conditioned<T> condition_by_modes(const LandmarkObservation&, const Sensor<T>&, const Pose<T>&,
                                             const Gaussian3<T>& d, std::size_t, AtPoint) {
  return {d, T(0.0F)};  // points have one hypothesis
}

template <class T, class Model>
HWY_INLINE void condition_range(const LandmarkObservation& observation, const Increment& expected,
                                const PoseColumns& before, double exponent,
                                const IncrementColumns& increments, double* log_weight, ParticleRange range) {
  const LandmarkObservation s = carried(observation, expected);
  for (std::size_t i = 0; i < range.count; i += width_of<T>()) {
    const Pose<T> pose = load_pose<T>(before, i);
    const Gaussian3<T> d = load_increment<T>(increments, i);
    const Sensor<T> from = sensor_of(moved(pose, d.x, d.y, d.t), s.mount);
    const Gaussian2<T> m = load_gaussian<T>(s.landmark.modes->gaussian, range.begin + i);
    const Conditioned<T> after =
        s.landmark.mode_count > 1 ? condition_by_modes(s, from, pose, d, range.begin + i, Model())
                                  : condition(Model::measure(s, from, m, range.begin + i), from, pose, d, m);
    store_increment(after.d, increments, i);
    add_scaled(after.log_likelihood, exponent, log_weight + i);  // Francisco (6)
  }
}

template <class T>
HWY_INLINE Sensor<T> load_sensor(const PoseColumns& sensors, std::size_t i) {
  const Pose<T> pose = load_pose<T>(sensors, i);
  return {pose.x, pose.y, pose.c, pose.s, T(0.0F), T(0.0F)};
}

template <class T, class Model>
HWY_INLINE void update_range(const LandmarkObservation& s, const PoseColumns& sensors, double exponent,
                             double* log_weight, ParticleRange range) {
  const GaussianColumns& gaussian = s.landmark.modes->gaussian;
  for (std::size_t i = 0; i < range.count; i += width_of<T>()) {
    const Sensor<T> from = load_sensor<T>(sensors, i);
    const Gaussian2<T> m = load_gaussian<T>(gaussian, range.begin + i);
    const Updated<T> after = update(Model::measure(s, from, m, range.begin + i), m);
    store_gaussian(possible(s, after.m, Model()), gaussian, range.begin + i);
    if (log_weight != nullptr) add_scaled(after.log_likelihood, exponent, log_weight + i);  // Francisco (6)
  }
}

// A hypothesis that the sensor could not have seen dies, unless it could have seen none. It is the state that
// is out of view, not the observation that is unlikely: to count that at every observation would be to count
// it again and again.
template <class T, class Model>
HWY_INLINE T log_possible(const LandmarkObservation& s, const Sensor<T>& from, const Gaussian2<T>& m,
                          std::size_t i, Model) {
  if (!std::is_same_v<Model, RangeOfRing> || s.mount.half_view >= 3.14F) return T(0.0F);
  const Ray<T> ray = measure_ring(s.seen, range_of<T>(s.seen, i), from, m, anchor_x<T>(s.landmark, i),
                                  anchor_y<T>(s.landmark, i))
                         .ray;
  const T across = m.b * ray.inverse_r;
  const T sigma = square_root(m.aa * across * across + T(kViewEdgeVariance));
  const T outside = absolute(off_axis(s.mount, from, ray)) - T(s.mount.half_view);
  return where_less(T(kDeviationsOutside) * sigma, outside, T(2.0F * kLogDrop), T(0.0F));
}

// Updates a hypothesis and returns its log weight before normalisation.
template <class T, class Model>
HWY_INLINE T update_mode(const LandmarkObservation& s, const Sensor<T>& from, const LandmarkMode& mode,
                         std::size_t i) {
  const Gaussian2<T> m = load_gaussian<T>(mode.gaussian, i);
  const Updated<T> after = update(Model::measure(s, from, m, i), m);
  store_gaussian(possible(s, after.m, Model()), mode.gaussian, i);
  const T before = load<T>(mode.log_weight, i);
  const T weight = before + after.log_likelihood + log_possible(s, from, m, i, Model());
  return where_less(T(0.5F * kDeadMode), before, weight, T(kDeadMode));
}

// Keeps the hypotheses that are not far below the best one, normalised; returns the log of their sum.
template <class T>
HWY_INLINE T keep_modes(const LandmarkView& landmark, const float* log_weights, T best, std::size_t i) {
  T all = T(0.0F);
  T kept = T(0.0F);
  for (std::size_t k = 0; k < landmark.mode_count; ++k) {
    const T below = load<T>(log_weights, k * kParticleLanes) - best;
    const T part = exponential(below);
    all = all + part;
    kept = kept + where_less(below, T(kLogDrop), T(0.0F), part);
  }
  const T log_kept = logarithm(kept);
  for (std::size_t k = 0; k < landmark.mode_count; ++k) {
    const T below = load<T>(log_weights, k * kParticleLanes) - best;
    store(where_less(below, T(kLogDrop), T(kDeadMode), below - log_kept), landmark.modes[k].log_weight, i);
  }
  return best + logarithm(all);
}

// The hypotheses of one vector of particles; returns the log-likelihood of the observation.
template <class T, class Model>
HWY_INLINE T update_modes(const LandmarkObservation& s, const Sensor<T>& from, std::size_t i) {
  alignas(64) float log_weights[kMaxModes * kParticleLanes];
  T best = T(kDeadMode);
  for (std::size_t k = 0; k < s.landmark.mode_count; ++k) {
    const T log_weight = update_mode<T, Model>(s, from, s.landmark.modes[k], i);
    store(log_weight, log_weights, k * kParticleLanes);
    best = larger(best, log_weight);
  }
  return keep_modes(s.landmark, log_weights, best, i);
}

template <class T, class Model>
HWY_INLINE void update_modes_range(const LandmarkObservation& s, const PoseColumns& sensors, double exponent,
                                   double* log_weight, ParticleRange range) {
  for (std::size_t i = 0; i < range.count; i += width_of<T>()) {
    const T log_likelihood = update_modes<T, Model>(s, load_sensor<T>(sensors, i), range.begin + i);
    if (log_weight != nullptr) add_scaled(log_likelihood, exponent, log_weight + i);  // Francisco (6)
  }
}

// Where a hypothesis of a ray or a ring is, and how unsure.
template <class T>
struct Place {
  Ray<T> ray;
  T bearing_var, range_var;
};

template <class T>
HWY_INLINE Place<T> place_of(const LandmarkObservation& s, const Sensor<T>& from, const Gaussian2<T>& m,
                             std::size_t i) {
  const bool is_ray = s.landmark.form == LandmarkForm::kRay;
  const T depth = is_ray ? inverse(larger(m.b, T(s.mount.min_rho))) : m.b;
  const T depth_var = is_ray ? m.bb * depth * depth * depth * depth : m.bb;
  const auto phi = sin_cos(m.a);
  const Ray<T> ray = ray_of(anchor_x<T>(s.landmark, i) - from.x + depth * phi.cos,
                            anchor_y<T>(s.landmark, i) - from.y + depth * phi.sin);
  // Along and across the line of sight, of what lies along and across that from the anchor.
  const T c = ray.ux * phi.cos + ray.uy * phi.sin;
  const T along = depth_var;
  const T across = m.aa * depth * depth;
  const T c_c = c * c;
  const T s_s = T(1.0F) - c_c;
  const T inverse_square = ray.inverse_r * ray.inverse_r;
  return {ray, (c_c * across + s_s * along) * inverse_square, c_c * along + s_s * across};
}

// 1 for what lies inside the limits by so many standard deviations, else 0: what may be out of view may have
// been missed at every scan for the same reason.
template <class T>
HWY_INLINE T clearly_in_view(const LandmarkObservation& s, const Sensor<T>& from, const Place<T>& p) {
  const T reach_margin = T(kDeviationsInside) * square_root(p.range_var + T(kReachVariance));
  const T far = inverse(T(s.mount.min_rho)) - p.ray.r - reach_margin;
  const T near = p.ray.r - T(s.mount.min_range) - reach_margin;
  const T edge_margin = T(kDeviationsInside) * square_root(p.bearing_var + T(kViewEdgeVariance));
  const T edge = T(s.mount.half_view) - absolute(off_axis(s.mount, from, p.ray)) - edge_margin;
  const T inside = s.mount.half_view < 3.14F ? edge : T(1.0F);
  const T least = T(0.0F) - larger(T(0.0F) - inside, larger(T(0.0F) - far, T(0.0F) - near));
  return where_less(T(0.0F), least, T(1.0F), T(0.0F));
}

template <class T>
HWY_INLINE void miss_range(const LandmarkObservation& s, double detected, const PoseColumns& sensors,
                           ParticleRange range) {
  alignas(64) float log_weights[kMaxModes * kParticleLanes];
  for (std::size_t k = 0; k < range.count; k += width_of<T>()) {
    const std::size_t i = range.begin + k;
    const Sensor<T> from = load_sensor<T>(sensors, k);
    T best = T(kDeadMode);
    for (std::size_t m = 0; m < s.landmark.mode_count; ++m) {
      const LandmarkMode& mode = s.landmark.modes[m];
      const Place<T> place = place_of(s, from, load_gaussian<T>(mode.gaussian, i), i);
      const T missed = T(1.0F) - T(detected) * clearly_in_view(s, from, place);
      const T before = load<T>(mode.log_weight, i);
      const T after = where_less(T(0.5F * kDeadMode), before, before + logarithm(missed), T(kDeadMode));
      store(after, log_weights, m * kParticleLanes);
      best = larger(best, after);
    }
    keep_modes(s.landmark, log_weights, best, i);
  }
}

template <class T>
HWY_INLINE Gaussian2<T> first_point(const LandmarkMeasurement& z, T r, T x, T y, T ux, T uy) {
  const T R_aa = T(z.R_rr);
  const T R_at = r * T(z.R_rb);
  const T R_tt = r * r * T(z.R_bb);
  const T xx = ux * ux;
  const T xy = ux * uy;
  const T yy = uy * uy;
  return {x + r * ux, y + r * uy, xx * R_aa - T(2.0F) * xy * R_at + yy * R_tt,
          xy * (R_aa - R_tt) + (xx - yy) * R_at, yy * R_aa + T(2.0F) * xy * R_at + xx * R_tt};
}

// A ray in direction `phi`, a ring about it.
template <class T>
HWY_INLINE void place_modes(const LandmarkObservation& s, const FirstGuess& guess, T phi, std::size_t i) {
  const bool is_ray = s.landmark.form == LandmarkForm::kRay;
  for (std::size_t k = 0; k < s.landmark.mode_count; ++k) {
    const LandmarkMode& mode = s.landmark.modes[k];
    const FirstMode& first = guess.modes[k];
    store_gaussian(is_ray ? Gaussian2<T>{phi, T(first.value), T(s.seen.R_bb), T(0.0F), T(first.variance)}
                          : Gaussian2<T>{phi + T(first.value), range_of<T>(s.seen, i), T(first.variance),
                                         T(0.0F), T(s.seen.R_rr)},
                   mode.gaussian, i);
    if (mode.log_weight != nullptr) store(T(first.log_weight), mode.log_weight, i);
  }
}

template <class T>
HWY_INLINE void place_range(const LandmarkObservation& s, const FirstGuess& guess, const PoseColumns& sensors,
                            ParticleRange range) {
  const auto direction = [](const Sensor<T>& from, float c, float sine) HWY_ATTR {
    return SinCos<T>{from.s * T(c) + from.c * T(sine), from.c * T(c) - from.s * T(sine)};
  };
  const GaussianColumns& gaussian = s.landmark.modes->gaussian;
  for (std::size_t k = 0; k < range.count; k += width_of<T>()) {
    const std::size_t i = range.begin + k;
    const Sensor<T> from = load_sensor<T>(sensors, k);
    const T x = from.x - T(s.landmark.offset_x);
    const T y = from.y - T(s.landmark.offset_y);
    const SinCos<T> u = direction(from, s.seen.cos_bearing, s.seen.sin_bearing);
    if (s.landmark.form == LandmarkForm::kPoint) {
      store_gaussian(first_point(s.seen, range_of<T>(s.seen, i), x, y, u.cos, u.sin), gaussian, i);
      continue;
    }
    store(x, s.landmark.anchor_x, i);
    store(y, s.landmark.anchor_y, i);
    const SinCos<T> axis =
        s.landmark.form == LandmarkForm::kRay ? u : direction(from, s.mount.cos_yaw, s.mount.sin_yaw);
    place_modes(s, guess, angle_of(axis.sin, axis.cos), i);
  }
}

template <class T>
HWY_INLINE InnovationSums compare_as(const LandmarkObservation& s, const Increment& increment,
                                     const PoseColumns& before, const About& about, const double* weight,
                                     ParticleRange range) {
  return dispatch_model(s, [&](auto model) HWY_ATTR {
    return compare_range<T, decltype(model)>(s, increment, before, about, weight, range);
  });
}

template <class T>
HWY_INLINE void list_as(const LandmarkObservation& s, const Increment& increment, const PoseColumns& before,
                        const About& about, float* nu_r, float* nu_b, ParticleRange range) {
  dispatch_model(s, [&](auto model) HWY_ATTR {
    list_range<T, decltype(model)>(s, increment, before, about, nu_r, nu_b, range);
  });
}

template <class T>
HWY_INLINE void condition_as(const LandmarkObservation& s, const Increment& expected,
                             const PoseColumns& before, double exponent, const IncrementColumns& increments,
                             double* log_weight, ParticleRange range) {
  dispatch_model(s, [&](auto model) HWY_ATTR {
    condition_range<T, decltype(model)>(s, expected, before, exponent, increments, log_weight, range);
  });
}

template <class T>
HWY_INLINE void update_as(const LandmarkObservation& s, const PoseColumns& sensors, double exponent,
                          double* log_weight, ParticleRange range) {
  dispatch_model(s, [&](auto model) HWY_ATTR {
    if (s.landmark.mode_count > 1)
      update_modes_range<T, decltype(model)>(s, sensors, exponent, log_weight, range);
    else
      update_range<T, decltype(model)>(s, sensors, exponent, log_weight, range);
  });
}

InnovationSums compare_lanes(const LandmarkObservation& s, const Increment& increment,
                             const PoseColumns& before, const About& about, const double* weight,
                             ParticleRange range) {
  return compare_as<Lanes>(s, increment, before, about, weight, range);
}

void list_lanes(const LandmarkObservation& s, const Increment& increment, const PoseColumns& before,
                const About& about, float* nu_r, float* nu_b, ParticleRange range) {
  list_as<Lanes>(s, increment, before, about, nu_r, nu_b, range);
}

void condition_lanes(const LandmarkObservation& s, const Increment& expected, const PoseColumns& before,
                     double exponent, const IncrementColumns& increments, double* log_weight,
                     ParticleRange range) {
  condition_as<Lanes>(s, expected, before, exponent, increments, log_weight, range);
}

void update_lanes(const LandmarkObservation& s, const PoseColumns& sensors, double exponent,
                  double* log_weight, ParticleRange range) {
  update_as<Lanes>(s, sensors, exponent, log_weight, range);
}

void miss_lanes(const LandmarkObservation& s, double detected, const PoseColumns& sensors,
                ParticleRange range) {
  miss_range<Lanes>(s, detected, sensors, range);
}

void place_lanes(const LandmarkObservation& s, const FirstGuess& guess, const PoseColumns& sensors,
                 ParticleRange range) {
  place_range<Lanes>(s, guess, sensors, range);
}

}  // namespace waymark::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace waymark::kernels {

HWY_EXPORT(compare_lanes);
HWY_EXPORT(list_lanes);
HWY_EXPORT(condition_lanes);
HWY_EXPORT(update_lanes);
HWY_EXPORT(miss_lanes);
HWY_EXPORT(place_lanes);

InnovationSums compare_observation(const LandmarkObservation& observation, const Increment& increment,
                                   const PoseColumns& before, const About& about, const double* weight,
                                   ParticleRange range) {
  return HWY_DYNAMIC_DISPATCH(compare_lanes)(observation, increment, before, about, weight, range);
}

void list_innovations(const LandmarkObservation& observation, const Increment& increment,
                      const PoseColumns& before, const About& about, float* nu_r, float* nu_b,
                      ParticleRange range) {
  HWY_DYNAMIC_DISPATCH(list_lanes)(observation, increment, before, about, nu_r, nu_b, range);
}

void condition_increments(const LandmarkObservation& observation, const Increment& expected,
                          const PoseColumns& before, double exponent, const IncrementColumns& increments,
                          double* log_weight, ParticleRange range) {
  HWY_DYNAMIC_DISPATCH(condition_lanes)
  (observation, expected, before, exponent, increments, log_weight, range);
}

void update_landmark(const LandmarkObservation& observation, const PoseColumns& sensors, double exponent,
                     double* log_weight, ParticleRange range) {
  HWY_DYNAMIC_DISPATCH(update_lanes)(observation, sensors, exponent, log_weight, range);
}

void miss_modes(const LandmarkObservation& observation, double detected, const PoseColumns& sensors,
                ParticleRange range) {
  HWY_DYNAMIC_DISPATCH(miss_lanes)(observation, detected, sensors, range);
}

void place_landmark(const LandmarkObservation& observation, const FirstGuess& guess,
                    const PoseColumns& sensors, ParticleRange range) {
  HWY_DYNAMIC_DISPATCH(place_lanes)(observation, guess, sensors, range);
}

namespace reference {

InnovationSums compare_observation(const LandmarkObservation& observation, const Increment& increment,
                                   const PoseColumns& before, const About& about, const double* weight,
                                   ParticleRange range) {
  return HWY_NAMESPACE::compare_as<double>(observation, increment, before, about, weight, range);
}

void list_innovations(const LandmarkObservation& observation, const Increment& increment,
                      const PoseColumns& before, const About& about, float* nu_r, float* nu_b,
                      ParticleRange range) {
  HWY_NAMESPACE::list_as<double>(observation, increment, before, about, nu_r, nu_b, range);
}

void condition_increments(const LandmarkObservation& observation, const Increment& expected,
                          const PoseColumns& before, double exponent, const IncrementColumns& increments,
                          double* log_weight, ParticleRange range) {
  HWY_NAMESPACE::condition_as<double>(observation, expected, before, exponent, increments, log_weight, range);
}

void update_landmark(const LandmarkObservation& observation, const PoseColumns& sensors, double exponent,
                     double* log_weight, ParticleRange range) {
  HWY_NAMESPACE::update_as<double>(observation, sensors, exponent, log_weight, range);
}

void miss_modes(const LandmarkObservation& observation, double detected, const PoseColumns& sensors,
                ParticleRange range) {
  HWY_NAMESPACE::miss_range<double>(observation, detected, sensors, range);
}

void place_landmark(const LandmarkObservation& observation, const FirstGuess& guess,
                    const PoseColumns& sensors, ParticleRange range) {
  HWY_NAMESPACE::place_range<double>(observation, guess, sensors, range);
}

}  // namespace reference
}  // namespace waymark::kernels
#endif
