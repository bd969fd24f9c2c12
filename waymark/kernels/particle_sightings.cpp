#include "waymark/kernels/particle_sightings.hpp"

#include <algorithm>
#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "waymark/kernels/particle_sightings.cpp"
// Structs of vectors need a vector size known at compile time; SVE machines run the NEON code.
#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "waymark/kernels/particle_formulas-inl.h"

HWY_BEFORE_NAMESPACE();
namespace waymark::kernels::HWY_NAMESPACE {

// Hypotheses below this part of the best one are dropped: log 1e-3.
constexpr float kLogDrop = -6.9F;

// How sharp the edges of a field of view are, besides what is unsure about the hypothesis: (2 deg)^2; and how
// far outside a hypothesis dies.
constexpr float kViewEdgeVariance = 0.0012F;
constexpr float kDeviationsOutside = 3.0F;

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

// The ways to look at a landmark of one hypothesis. Each is a type, so that loops over particles do not
// choose.
struct AtPoint {
  template <class T>
  static HWY_INLINE Look2<T> look(const Sighting& s, const Sensor<T>& from, const Gaussian2<T>& m,
                                  std::size_t) {
    return look_at_point(s.seen, from, m, T(s.landmark.offset_x), T(s.landmark.offset_y));
  }
};
struct RangeOfPoint {
  template <class T>
  static HWY_INLINE Look1<T> look(const Sighting& s, const Sensor<T>& from, const Gaussian2<T>& m,
                                  std::size_t) {
    return look_range(s.seen, from, m, T(s.landmark.offset_x), T(s.landmark.offset_y));
  }
};
struct BearingOfPoint {
  template <class T>
  static HWY_INLINE Look1<T> look(const Sighting& s, const Sensor<T>& from, const Gaussian2<T>& m,
                                  std::size_t) {
    return look_bearing(s.seen, from, m, T(s.landmark.offset_x), T(s.landmark.offset_y));
  }
};
struct BearingOfRay {
  template <class T>
  static HWY_INLINE Look1<T> look(const Sighting& s, const Sensor<T>& from, const Gaussian2<T>& m,
                                  std::size_t i) {
    return look_along_ray(s.seen, from, m, anchor_x<T>(s.landmark, i), anchor_y<T>(s.landmark, i));
  }
};
struct RangeOfRing {
  template <class T>
  static HWY_INLINE Look1<T> look(const Sighting& s, const Sensor<T>& from, const Gaussian2<T>& m,
                                  std::size_t i) {
    return look_across_ring(s.seen, from, m, anchor_x<T>(s.landmark, i), anchor_y<T>(s.landmark, i)).look;
  }
};

// Calls job(way) with the way in which such a sighting looks at such a landmark.
template <class Job>
HWY_INLINE auto choose_way(const Sighting& s, const Job& job) {
  if (s.landmark.form == LandmarkForm::kRay) return job(BearingOfRay());
  if (s.landmark.form == LandmarkForm::kRing) return job(RangeOfRing());
  if (s.seen.kind == SightingKind::kRange) return job(RangeOfPoint());
  if (s.seen.kind == SightingKind::kBearing) return job(BearingOfPoint());
  return job(AtPoint());
}

template <class T>
HWY_INLINE Updated<T> update(const Look2<T>& look, const Gaussian2<T>& m) {
  return update2(look, m);
}
template <class T>
HWY_INLINE Updated<T> update(const Look1<T>& look, const Gaussian2<T>& m) {
  return update1(look, m);
}

// What a landmark cannot be is not kept: a ray does not reach beyond the sensor's range, let alone infinity.
template <class T, class Way>
HWY_INLINE Gaussian2<T> possible(const Sighting&, const Gaussian2<T>& m, Way) {
  return m;
}
template <class T>
HWY_INLINE Gaussian2<T> possible(const Sighting& s, const Gaussian2<T>& m, BearingOfRay) {
  const T rho = larger(m.b, T(s.mount.least_rho));
  const T shift = rho - m.b;
  return {m.a, rho, m.aa, m.ab, m.bb + shift * shift};
}

template <class T>
HWY_INLINE Conditioned<T> condition(const Look2<T>& look, const Sensor<T>& from, const Pose<T>& before,
                                    const Gaussian3<T>& d, const Gaussian2<T>& m) {
  return condition2(d, rows_of(look, from, before), look, m);
}
template <class T>
HWY_INLINE Conditioned<T> condition(const Look1<T>& look, const Sensor<T>&, const Pose<T>& before,
                                    const Gaussian3<T>& d, const Gaussian2<T>& m) {
  return condition1(d, in_frame_of(before, look.g_x, look.g_y, look.g_t), look.nu,
                    landmark_variance(look, m) + look.R);
}

// nu (r, b) and L (rr, rb, bb), in the units of the measurement.
template <class T>
struct Compared {
  T nu_r, nu_b, rr, rb, bb;
};

template <class T>
HWY_INLINE Compared<T> compare(const Look2<T>& l, const Sensor<T>& from, const Pose<T>& before,
                               const Gaussian3<T>& d, const Gaussian2<T>& m, SightingKind) {
  const Rows2<T> g = rows_of(l, from, before);
  const RayCovariance<T> L = innovation_covariance(l, m, g, times(d, g.a), times(d, g.t));
  const T inverse_r = l.ray.inverse_r;
  return {l.nu_a, l.nu_t * inverse_r, L.aa, L.at * inverse_r, L.tt * inverse_r * inverse_r};
}
template <class T>
HWY_INLINE Compared<T> compare(const Look1<T>& l, const Sensor<T>&, const Pose<T>& before,
                               const Gaussian3<T>& d, const Gaussian2<T>& m, SightingKind kind) {
  const Column3<T> g = in_frame_of(before, l.g_x, l.g_y, l.g_t);
  const T L = dot(g, times(d, g)) + landmark_variance(l, m) + l.R;
  const T zero = T(0.0F);
  if (kind == SightingKind::kRange) return {l.nu, zero, L, zero, zero};
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

template <class T, class Way>
HWY_INLINE InnovationSums compare_range(const Sighting& sighting, const Increment& increment,
                                        const PoseColumns& before, const About& about, const double* weight,
                                        ParticleRange range) {
  const Sighting s = carried(sighting, increment);
  const T zero = T(0.0F);
  const Gaussian3<T> d{zero,
                       zero,
                       zero,
                       T(increment.xx),
                       T(increment.xy),
                       T(increment.xt),
                       T(increment.yy),
                       T(increment.yt),
                       T(increment.tt)};
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
      const Compared<T> c = compare(Way::look(s, from, m, range.begin + i), from, pose, d, m, s.seen.kind);
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
HWY_INLINE Polar<T> innovation(const Look2<T>& l, SightingKind) {
  return {l.nu_a, l.nu_t * l.ray.inverse_r};
}
template <class T>
HWY_INLINE Polar<T> innovation(const Look1<T>& l, SightingKind kind) {
  const T zero = T(0.0F);
  if (kind == SightingKind::kRange) return {l.nu, zero};
  return {zero, l.nu};
}

template <class T, class Way>
HWY_INLINE void list_range(const Sighting& sighting, const Increment& increment, const PoseColumns& before,
                           const About& about, float* nu_r, float* nu_b, ParticleRange range) {
  const Sighting s = carried(sighting, increment);
  for (std::size_t i = 0; i < range.count; i += width_of<T>()) {
    const Sensor<T> from = sensor_of(load_pose<T>(before, i), s.mount);
    const Gaussian2<T> m = load_gaussian<T>(s.landmark.modes->gaussian, range.begin + i);
    const Polar<T> nu = innovation(Way::look(s, from, m, range.begin + i), s.seen.kind);
    store(nu.range - T(about.range), nu_r, i);
    store(wrapped(nu.bearing - T(about.bearing)), nu_b, i);
  }
}

// What several hypotheses together say of the robot: one look of the moments of theirs.
template <class T>
struct Mixture {
  T nu, Z, g_x, g_y, g_t;
};

template <class T, class Way>
HWY_INLINE Mixture<T> look_at_modes(const Sighting& s, const Sensor<T>& from, std::size_t i) {
  const T zero = T(0.0F);
  Mixture<T> sum{zero, zero, zero, zero, zero};
  T nu_nu = zero;
  for (std::size_t k = 0; k < s.landmark.mode_count; ++k) {
    const LandmarkMode& mode = s.landmark.modes[k];
    const Gaussian2<T> m = load_gaussian<T>(mode.gaussian, i);
    const Look1<T> look = Way::look(s, from, m, i);
    const T log_weight = load<T>(mode.log_weight, i);
    const T w = exponential(log_weight);
    const auto add = [&](T& to, T x)
                         HWY_ATTR { to = to + where_less(T(-20.0F), log_weight, w * x, T(0.0F)); };
    add(sum.nu, look.nu);
    add(nu_nu, look.nu * look.nu);
    add(sum.Z, landmark_variance(look, m) + look.R);
    add(sum.g_x, look.g_x);
    add(sum.g_y, look.g_y);
    add(sum.g_t, look.g_t);
  }
  sum.Z = sum.Z + larger(nu_nu - sum.nu * sum.nu, zero);
  return sum;
}

template <class T, class Way>
HWY_INLINE Conditioned<T> condition_by_modes(const Sighting& s, const Sensor<T>& from, const Pose<T>& before,
                                             const Gaussian3<T>& d, std::size_t i, Way) {
  const Mixture<T> m = look_at_modes<T, Way>(s, from, i);
  return condition1(d, in_frame_of(before, m.g_x, m.g_y, m.g_t), m.nu, m.Z);
}
template <class T>
HWY_INLINE Conditioned<T> condition_by_modes(const Sighting&, const Sensor<T>&, const Pose<T>&,
                                             const Gaussian3<T>& d, std::size_t, AtPoint) {
  return {d, T(0.0F)};  // points have one hypothesis
}

template <class T, class Way>
HWY_INLINE void condition_range(const Sighting& sighting, const Increment& expected,
                                const PoseColumns& before, double evidence,
                                const IncrementColumns& increments, double* log_weight, ParticleRange range) {
  const Sighting s = carried(sighting, expected);
  for (std::size_t i = 0; i < range.count; i += width_of<T>()) {
    const Pose<T> pose = load_pose<T>(before, i);
    const Gaussian3<T> d = load_increment<T>(increments, i);
    const Sensor<T> from = sensor_of(moved(pose, d.x, d.y, d.t), s.mount);
    const Gaussian2<T> m = load_gaussian<T>(s.landmark.modes->gaussian, range.begin + i);
    const Conditioned<T> after = s.landmark.mode_count > 1
                                     ? condition_by_modes(s, from, pose, d, range.begin + i, Way())
                                     : condition(Way::look(s, from, m, range.begin + i), from, pose, d, m);
    store_increment(after.d, increments, i);
    add_scaled(after.log_likelihood, evidence, log_weight + i);
  }
}

template <class T>
HWY_INLINE Sensor<T> load_sensor(const PoseColumns& sensors, std::size_t i) {
  const Pose<T> pose = load_pose<T>(sensors, i);
  return {pose.x, pose.y, pose.c, pose.s, T(0.0F), T(0.0F)};
}

template <class T, class Way>
HWY_INLINE void update_range(const Sighting& s, const PoseColumns& sensors, double evidence,
                             double* log_weight, ParticleRange range) {
  const GaussianColumns& gaussian = s.landmark.modes->gaussian;
  for (std::size_t i = 0; i < range.count; i += width_of<T>()) {
    const Sensor<T> from = load_sensor<T>(sensors, i);
    const Gaussian2<T> m = load_gaussian<T>(gaussian, range.begin + i);
    const Updated<T> after = update(Way::look(s, from, m, range.begin + i), m);
    store_gaussian(possible(s, after.m, Way()), gaussian, range.begin + i);
    if (log_weight != nullptr) add_scaled(after.log_likelihood, evidence, log_weight + i);
  }
}

// A hypothesis that the sensor could not have seen dies. It is the state that is out of view, not the
// sighting that is unlikely: to count that at every sighting would be to count it again and again.
template <class T>
HWY_INLINE T log_possible(const Sighting& s, const Sensor<T>& from, const Gaussian2<T>& m, std::size_t i,
                          RangeOfRing) {
  if (s.mount.half_view >= 3.14F) return T(0.0F);
  const Ray<T> ray =
      look_across_ring(s.seen, from, m, anchor_x<T>(s.landmark, i), anchor_y<T>(s.landmark, i)).ray;
  const T across = m.b * ray.inverse_r;
  const T sigma = square_root(m.aa * across * across + T(kViewEdgeVariance));
  return where_less(T(kDeviationsOutside), deviations_outside_view(s.mount, from, ray, sigma), T(kDeadMode),
                    T(0.0F));
}
template <class T, class Way>
HWY_INLINE T log_possible(const Sighting&, const Sensor<T>&, const Gaussian2<T>&, std::size_t, Way) {
  return T(0.0F);
}

// Updates a hypothesis and returns its log weight before normalisation.
template <class T, class Way>
HWY_INLINE T update_mode(const Sighting& s, const Sensor<T>& from, const LandmarkMode& mode, std::size_t i) {
  const Gaussian2<T> m = load_gaussian<T>(mode.gaussian, i);
  const Updated<T> after = update(Way::look(s, from, m, i), m);
  store_gaussian(possible(s, after.m, Way()), mode.gaussian, i);
  const T before = load<T>(mode.log_weight, i);
  const T weight = before + after.log_likelihood + log_possible(s, from, m, i, Way());
  return where_less(T(0.5F * kDeadMode), before, weight, T(kDeadMode));
}

// The hypotheses of one vector of particles; returns the log-likelihood of the sighting.
template <class T, class Way>
HWY_INLINE T update_modes(const Sighting& s, const Sensor<T>& from, std::size_t i) {
  alignas(64) float log_weights[kMaxModes * kParticleLanes];
  T best = T(kDeadMode);
  for (std::size_t k = 0; k < s.landmark.mode_count; ++k) {
    const T log_weight = update_mode<T, Way>(s, from, s.landmark.modes[k], i);
    store(log_weight, log_weights, k * kParticleLanes);
    best = larger(best, log_weight);
  }
  T all = T(0.0F);
  T kept = T(0.0F);
  for (std::size_t k = 0; k < s.landmark.mode_count; ++k) {
    const T below = load<T>(log_weights, k * kParticleLanes) - best;
    const T part = exponential(below);
    all = all + part;
    kept = kept + where_less(below, T(kLogDrop), T(0.0F), part);
  }
  const T log_kept = logarithm(kept);
  for (std::size_t k = 0; k < s.landmark.mode_count; ++k) {
    const T below = load<T>(log_weights, k * kParticleLanes) - best;
    store(where_less(below, T(kLogDrop), T(kDeadMode), below - log_kept), s.landmark.modes[k].log_weight, i);
  }
  return best + logarithm(all);
}

template <class T, class Way>
HWY_INLINE void update_modes_range(const Sighting& s, const PoseColumns& sensors, double evidence,
                                   double* log_weight, ParticleRange range) {
  for (std::size_t i = 0; i < range.count; i += width_of<T>()) {
    const T log_likelihood = update_modes<T, Way>(s, load_sensor<T>(sensors, i), range.begin + i);
    if (log_weight != nullptr) add_scaled(log_likelihood, evidence, log_weight + i);
  }
}

template <class T>
HWY_INLINE Gaussian2<T> first_point(const SeenLandmark& z, T x, T y, T ux, T uy) {
  const T r = T(z.range);
  const T R_aa = T(z.R_rr);
  const T R_at = r * T(z.R_rb);
  const T R_tt = r * r * T(z.R_bb);
  const T xx = ux * ux;
  const T xy = ux * uy;
  const T yy = uy * uy;
  return {x + r * ux, y + r * uy, xx * R_aa - T(2.0F) * xy * R_at + yy * R_tt,
          xy * (R_aa - R_tt) + (xx - yy) * R_at, yy * R_aa + T(2.0F) * xy * R_at + xx * R_tt};
}

template <class T>
HWY_INLINE void place_directions(const Sighting& s, const FirstGuess& guess, T axis, std::size_t i) {
  const auto modes = static_cast<double>(s.landmark.mode_count);
  for (std::size_t k = 0; k < s.landmark.mode_count; ++k) {
    const LandmarkMode& mode = s.landmark.modes[k];
    const T phi = axis + T((static_cast<double>(k) - 0.5 * (modes - 1.0)) * guess.phi_spacing);
    store_gaussian(Gaussian2<T>{phi, T(s.seen.range), T(guess.phi_var), T(0.0F), T(s.seen.R_rr)},
                   mode.gaussian, i);
    if (mode.log_weight != nullptr) store(T(-std::log(modes)), mode.log_weight, i);
  }
}

// Distances in a geometric series, each as likely as it is far: evenly spread.
template <class T>
HWY_INLINE void place_distances(const Sighting& s, const FirstGuess& guess, T phi, std::size_t i) {
  double depth = guess.depth;
  double all = 0.0;
  for (std::size_t k = 0; k < s.landmark.mode_count; ++k) {
    all += depth;
    depth *= guess.depth_ratio;
  }
  depth = guess.depth;
  for (std::size_t k = 0; k < s.landmark.mode_count; ++k) {
    const LandmarkMode& mode = s.landmark.modes[k];
    const double sigma = guess.depth_sigma / depth;
    store_gaussian(Gaussian2<T>{phi, T(1.0 / depth), T(s.seen.R_bb), T(0.0F), T(sigma * sigma)},
                   mode.gaussian, i);
    if (mode.log_weight != nullptr) store(T(std::log(depth / all)), mode.log_weight, i);
    depth *= guess.depth_ratio;
  }
}

template <class T>
HWY_INLINE void place_range(const Sighting& s, const FirstGuess& guess, const PoseColumns& sensors,
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
      store_gaussian(first_point(s.seen, x, y, u.cos, u.sin), gaussian, i);
      continue;
    }
    store(x, s.landmark.anchor_x, i);
    store(y, s.landmark.anchor_y, i);
    if (s.landmark.form == LandmarkForm::kRay) {
      place_distances(s, guess, angle_of(u.sin, u.cos), i);
    } else {
      const SinCos<T> axis = direction(from, s.mount.cos_yaw, s.mount.sin_yaw);
      place_directions(s, guess, angle_of(axis.sin, axis.cos), i);
    }
  }
}

template <class T>
HWY_INLINE InnovationSums compare_as(const Sighting& s, const Increment& increment, const PoseColumns& before,
                                     const About& about, const double* weight, ParticleRange range) {
  return choose_way(s, [&](auto way) HWY_ATTR {
    return compare_range<T, decltype(way)>(s, increment, before, about, weight, range);
  });
}

template <class T>
HWY_INLINE void list_as(const Sighting& s, const Increment& increment, const PoseColumns& before,
                        const About& about, float* nu_r, float* nu_b, ParticleRange range) {
  choose_way(s, [&](auto way) HWY_ATTR {
    list_range<T, decltype(way)>(s, increment, before, about, nu_r, nu_b, range);
  });
}

template <class T>
HWY_INLINE void condition_as(const Sighting& s, const Increment& expected, const PoseColumns& before,
                             double evidence, const IncrementColumns& increments, double* log_weight,
                             ParticleRange range) {
  choose_way(s, [&](auto way) HWY_ATTR {
    condition_range<T, decltype(way)>(s, expected, before, evidence, increments, log_weight, range);
  });
}

template <class T>
HWY_INLINE void update_as(const Sighting& s, const PoseColumns& sensors, double evidence, double* log_weight,
                          ParticleRange range) {
  choose_way(s, [&](auto way) HWY_ATTR {
    if (s.landmark.mode_count > 1)
      update_modes_range<T, decltype(way)>(s, sensors, evidence, log_weight, range);
    else
      update_range<T, decltype(way)>(s, sensors, evidence, log_weight, range);
  });
}

InnovationSums compare_lanes(const Sighting& s, const Increment& increment, const PoseColumns& before,
                             const About& about, const double* weight, ParticleRange range) {
  return compare_as<Lanes>(s, increment, before, about, weight, range);
}

void list_lanes(const Sighting& s, const Increment& increment, const PoseColumns& before, const About& about,
                float* nu_r, float* nu_b, ParticleRange range) {
  list_as<Lanes>(s, increment, before, about, nu_r, nu_b, range);
}

void condition_lanes(const Sighting& s, const Increment& expected, const PoseColumns& before, double evidence,
                     const IncrementColumns& increments, double* log_weight, ParticleRange range) {
  condition_as<Lanes>(s, expected, before, evidence, increments, log_weight, range);
}

void update_lanes(const Sighting& s, const PoseColumns& sensors, double evidence, double* log_weight,
                  ParticleRange range) {
  update_as<Lanes>(s, sensors, evidence, log_weight, range);
}

void place_lanes(const Sighting& s, const FirstGuess& guess, const PoseColumns& sensors,
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
HWY_EXPORT(place_lanes);

InnovationSums compare_sighting(const Sighting& sighting, const Increment& increment,
                                const PoseColumns& before, const About& about, const double* weight,
                                ParticleRange range) {
  return HWY_DYNAMIC_DISPATCH(compare_lanes)(sighting, increment, before, about, weight, range);
}

void list_innovations(const Sighting& sighting, const Increment& increment, const PoseColumns& before,
                      const About& about, float* nu_r, float* nu_b, ParticleRange range) {
  HWY_DYNAMIC_DISPATCH(list_lanes)(sighting, increment, before, about, nu_r, nu_b, range);
}

void condition_increments(const Sighting& sighting, const Increment& expected, const PoseColumns& before,
                          double evidence, const IncrementColumns& increments, double* log_weight,
                          ParticleRange range) {
  HWY_DYNAMIC_DISPATCH(condition_lanes)(sighting, expected, before, evidence, increments, log_weight, range);
}

void update_landmark(const Sighting& sighting, const PoseColumns& sensors, double evidence,
                     double* log_weight, ParticleRange range) {
  HWY_DYNAMIC_DISPATCH(update_lanes)(sighting, sensors, evidence, log_weight, range);
}

void place_landmark(const Sighting& sighting, const FirstGuess& guess, const PoseColumns& sensors,
                    ParticleRange range) {
  HWY_DYNAMIC_DISPATCH(place_lanes)(sighting, guess, sensors, range);
}

namespace reference {

InnovationSums compare_sighting(const Sighting& sighting, const Increment& increment,
                                const PoseColumns& before, const About& about, const double* weight,
                                ParticleRange range) {
  return HWY_NAMESPACE::compare_as<double>(sighting, increment, before, about, weight, range);
}

void list_innovations(const Sighting& sighting, const Increment& increment, const PoseColumns& before,
                      const About& about, float* nu_r, float* nu_b, ParticleRange range) {
  HWY_NAMESPACE::list_as<double>(sighting, increment, before, about, nu_r, nu_b, range);
}

void condition_increments(const Sighting& sighting, const Increment& expected, const PoseColumns& before,
                          double evidence, const IncrementColumns& increments, double* log_weight,
                          ParticleRange range) {
  HWY_NAMESPACE::condition_as<double>(sighting, expected, before, evidence, increments, log_weight, range);
}

void update_landmark(const Sighting& sighting, const PoseColumns& sensors, double evidence,
                     double* log_weight, ParticleRange range) {
  HWY_NAMESPACE::update_as<double>(sighting, sensors, evidence, log_weight, range);
}

void place_landmark(const Sighting& sighting, const FirstGuess& guess, const PoseColumns& sensors,
                    ParticleRange range) {
  HWY_NAMESPACE::place_range<double>(sighting, guess, sensors, range);
}

}  // namespace reference
}  // namespace waymark::kernels
#endif
