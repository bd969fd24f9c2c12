// The formulas of FastSLAM for one particle (T = double) or one vector of particles (T = Lanes). Compiled
// once per instruction set, hence no #pragma once.
#if defined(WAYMARK_KERNELS_PARTICLE_FORMULAS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef WAYMARK_KERNELS_PARTICLE_FORMULAS_INL_H
#undef WAYMARK_KERNELS_PARTICLE_FORMULAS_INL_H
#else
#define WAYMARK_KERNELS_PARTICLE_FORMULAS_INL_H
#endif

#include <cmath>
#include <cstddef>

#include "waymark/kernels/lanes-inl.h"
#include "waymark/kernels/particle_columns.hpp"
#include "waymark/kernels/particle_observations.hpp"

HWY_BEFORE_NAMESPACE();
namespace waymark::kernels::HWY_NAMESPACE {

/// A pose with its heading as a direction.
template <class T>
struct Pose {
  T x, y, c, s;
};

/// Where a sensor is: its position, the robot's heading, and the arm from the robot to it, all in the world.
template <class T>
struct Sensor {
  T x, y, c, s, arm_x, arm_y;
};

template <class T>
struct Gaussian2 {
  T a, b, aa, ab, bb;
};

template <class T>
struct Gaussian3 {
  T x, y, t, xx, xy, xt, yy, yt, tt;
};

/// Rounding must not make a covariance indefinite: its determinant is at least what rounding makes of 0.
template <class T>
HWY_INLINE T determinant(const Gaussian2<T>& m) {
  return larger(m.aa * m.bb - m.ab * m.ab, m.aa * m.bb * T(1e-7F));
}

template <class T>
HWY_INLINE Pose<T> load_pose(const PoseColumns& p, std::size_t i) {
  return {load<T>(p.x, i), load<T>(p.y, i), load<T>(p.cos, i), load<T>(p.sin, i)};
}

template <class T>
HWY_INLINE void store_pose(const Pose<T>& pose, const PoseColumns& p, std::size_t i) {
  store(pose.x, p.x, i);
  store(pose.y, p.y, i);
  store(pose.c, p.cos, i);
  store(pose.s, p.sin, i);
}

template <class T>
HWY_INLINE Gaussian2<T> load_gaussian(const GaussianColumns& m, std::size_t i) {
  return {load<T>(m.a, i), load<T>(m.b, i), load<T>(m.aa, i), load<T>(m.ab, i), load<T>(m.bb, i)};
}

template <class T>
HWY_INLINE void store_gaussian(const Gaussian2<T>& g, const GaussianColumns& m, std::size_t i) {
  store(g.a, m.a, i);
  store(g.b, m.b, i);
  store(g.aa, m.aa, i);
  store(g.ab, m.ab, i);
  store(g.bb, m.bb, i);
}

template <class T>
HWY_INLINE Gaussian3<T> load_increment(const IncrementColumns& d, std::size_t i) {
  return {load<T>(d.x, i),  load<T>(d.y, i),  load<T>(d.t, i),  load<T>(d.xx, i), load<T>(d.xy, i),
          load<T>(d.xt, i), load<T>(d.yy, i), load<T>(d.yt, i), load<T>(d.tt, i)};
}

/// The increment before anything is seen, about the expected one.
template <class T>
HWY_INLINE Gaussian3<T> unseen(const Increment& d) {
  const T zero = T(0.0F);
  return {zero, zero, zero, T(d.xx), T(d.xy), T(d.xt), T(d.yy), T(d.yt), T(d.tt)};
}

template <class T>
HWY_INLINE void store_increment(const Gaussian3<T>& g, const IncrementColumns& d, std::size_t i) {
  store(g.x, d.x, i);
  store(g.y, d.y, i);
  store(g.t, d.t, i);
  store(g.xx, d.xx, i);
  store(g.xy, d.xy, i);
  store(g.xt, d.xt, i);
  store(g.yy, d.yy, i);
  store(g.yt, d.yt, i);
  store(g.tt, d.tt, i);
}

/// The pose after the increment (x, y, t) in the frame of the pose before.
template <class T>
HWY_INLINE Pose<T> moved(const Pose<T>& p, T x, T y, T t) {
  const auto turn = sin_cos(t);
  return {p.x + p.c * x - p.s * y, p.y + p.s * x + p.c * y, p.c * turn.cos - p.s * turn.sin,
          p.s * turn.cos + p.c * turn.sin};
}

template <class T>
HWY_INLINE Sensor<T> sensor_of(const Pose<T>& robot, const SensorMount& mount) {
  const T arm_x = robot.c * T(mount.x) - robot.s * T(mount.y);
  const T arm_y = robot.s * T(mount.x) + robot.c * T(mount.y);
  return {robot.x + arm_x, robot.y + arm_y, robot.c, robot.s, arm_x, arm_y};
}

/// The angle from direction (ux, uy) in the world to where the landmark was seen: the bearing's innovation,
/// without a difference to wrap.
template <class T>
HWY_INLINE T bearing_innovation(const LandmarkMeasurement& z, const Sensor<T>& from, T ux, T uy) {
  const T ahead = from.c * ux + from.s * uy;
  const T left = from.c * uy - from.s * ux;
  const T cb = T(z.cos_bearing);
  const T sb = T(z.sin_bearing);
  return angle_of(sb * ahead - cb * left, cb * ahead + sb * left);
}

/// From the sensor to a landmark: length, and direction in the world.
template <class T>
struct Ray {
  T r, inverse_r, ux, uy;
};

template <class T>
HWY_INLINE Ray<T> ray_of(T dx, T dy) {
  const T square = larger(dx * dx + dy * dy, T(kNearest * kNearest));
  const T inverse_r = inverse_root(square);
  return {square * inverse_r, inverse_r, dx * inverse_r, dy * inverse_r};
}

/// The range as a particle understands it.
template <class T>
HWY_INLINE T range_of(const LandmarkMeasurement& z, std::size_t i) {
  if (z.range_errors.offset == nullptr) return T(z.range);
  return (T(z.range) - load<T>(z.range_errors.offset, i)) * load<T>(z.range_errors.factor, i);
}

/// A distance measured and a direction measured, both in metres in the frame of the ray (along, across to the
/// left). In it the derivative by a point landmark is a rotation.
template <class T>
struct Measured2 {
  Ray<T> ray;
  T nu_a, nu_t;        ///< innovation
  T R_aa, R_at, R_tt;  ///< its noise
};

template <class T>
HWY_INLINE Measured2<T> measure_point(const LandmarkMeasurement& z, T range, const Sensor<T>& from,
                                      const Gaussian2<T>& m, T ox, T oy) {
  const Ray<T> ray = ray_of(m.a + ox - from.x, m.b + oy - from.y);
  const T nu_t = ray.r * bearing_innovation(z, from, ray.ux, ray.uy);
  return {ray, range - ray.r, nu_t, T(z.R_rr), ray.r * T(z.R_rb), ray.r * ray.r * T(z.R_bb)};
}

/// A symmetric 2x2 matrix in the frame of a ray.
template <class T>
struct RayCovariance {
  T aa, at, tt;
};

template <class T>
HWY_INLINE RayCovariance<T> along_ray(const Measured2<T>& measured, const Gaussian2<T>& m) {
  const T xx = measured.ray.ux * measured.ray.ux;
  const T xy = measured.ray.ux * measured.ray.uy;
  const T yy = measured.ray.uy * measured.ray.uy;
  return {xx * m.aa + T(2.0F) * xy * m.ab + yy * m.bb, xy * (m.bb - m.aa) + (xx - yy) * m.ab,
          yy * m.aa - T(2.0F) * xy * m.ab + xx * m.bb};
}

/// One number measured: innovation, noise, and the derivatives by the landmark's two numbers (a, b) and by
/// the robot's position and heading, in the world.
template <class T>
struct Measured1 {
  T nu, R, h_a, h_b, g_x, g_y, g_t;
};

template <class T>
HWY_INLINE T landmark_variance(const Measured1<T>& measured, const Gaussian2<T>& m) {
  return measured.h_a * measured.h_a * m.aa + T(2.0F) * measured.h_a * measured.h_b * m.ab +
         measured.h_b * measured.h_b * m.bb;
}

/// The range to a point: z = |d|, derivative by d its direction u.
template <class T>
HWY_INLINE Measured1<T> measure_range(const LandmarkMeasurement& z, T range, const Sensor<T>& from,
                                      const Gaussian2<T>& m, T ox, T oy) {
  const Ray<T> ray = ray_of(m.a + ox - from.x, m.b + oy - from.y);
  return {
      range - ray.r, T(z.R_rr), ray.ux, ray.uy, -ray.ux, -ray.uy, ray.ux * from.arm_y - ray.uy * from.arm_x};
}

/// The bearing of a point: derivative by d its perpendicular over its length.
template <class T>
HWY_INLINE Measured1<T> measure_bearing(const LandmarkMeasurement& z, const Sensor<T>& from,
                                        const Gaussian2<T>& m, T ox, T oy) {
  const Ray<T> ray = ray_of(m.a + ox - from.x, m.b + oy - from.y);
  const T tx = -ray.uy * ray.inverse_r;
  const T ty = ray.ux * ray.inverse_r;
  return {bearing_innovation(z, from, ray.ux, ray.uy), T(z.R_bb), tx, ty, -tx, -ty,
          tx * from.arm_y - ty * from.arm_x - T(1.0F)};
}

/// The bearing of an inverse-depth landmark (phi, rho) with anchor (ax, ay): with w = rho (anchor - sensor) +
/// (cos phi, sin phi), a vector of the same direction as the landmark, and J_w = (-w_y, w_x) / |w|^2,
/// d/d(phi, rho) = (J_w . (-sin phi, cos phi), J_w . (anchor - sensor)), d/d(position) = -rho J_w.
template <class T>
HWY_INLINE Measured1<T> measure_ray(const LandmarkMeasurement& z, const Sensor<T>& from,
                                    const Gaussian2<T>& m, T ax, T ay) {
  const auto phi = sin_cos(m.a);
  const T qx = ax - from.x;
  const T qy = ay - from.y;
  const Ray<T> w = ray_of(m.b * qx + phi.cos, m.b * qy + phi.sin);
  const T jx = -w.uy * w.inverse_r;
  const T jy = w.ux * w.inverse_r;
  const T gx = -m.b * jx;
  const T gy = -m.b * jy;
  return {bearing_innovation(z, from, w.ux, w.uy),
          T(z.R_bb),
          jy * phi.cos - jx * phi.sin,
          jx * qx + jy * qy,
          gx,
          gy,
          gy * from.arm_x - gx * from.arm_y - T(1.0F)};
}

/// The range to a landmark (phi, r) on a ring about its anchor (ax, ay), and how far off the sensor's axis it
/// would be.
template <class T>
struct MeasuredRing {
  Measured1<T> measured;
  Ray<T> ray;
};

template <class T>
HWY_INLINE MeasuredRing<T> measure_ring(const LandmarkMeasurement& z, T range, const Sensor<T>& from,
                                        const Gaussian2<T>& m, T ax, T ay) {
  const auto phi = sin_cos(m.a);
  const Ray<T> ray = ray_of(ax - from.x + m.b * phi.cos, ay - from.y + m.b * phi.sin);
  return {{range - ray.r, T(z.R_rr), m.b * (ray.uy * phi.cos - ray.ux * phi.sin),
           ray.ux * phi.cos + ray.uy * phi.sin, -ray.ux, -ray.uy, ray.ux * from.arm_y - ray.uy * from.arm_x},
          ray};
}

/// How far left of the sensor's axis that direction lies, in (-pi, pi].
template <class T>
HWY_INLINE T off_axis(const SensorMount& mount, const Sensor<T>& from, const Ray<T>& ray) {
  const T cx = from.c * T(mount.cos_yaw) - from.s * T(mount.sin_yaw);
  const T sx = from.s * T(mount.cos_yaw) + from.c * T(mount.sin_yaw);
  return angle_of(cx * ray.uy - sx * ray.ux, cx * ray.ux + sx * ray.uy);
}

/// The innovation of a bearing that is the nearer edge of the field of view.
template <class T>
HWY_INLINE T edge_innovation(const SensorMount& mount, const Sensor<T>& from, const Ray<T>& ray) {
  const T bearing = off_axis(mount, from, ray);
  const T edge = where_less(bearing, T(0.0F), T(-mount.half_view), T(mount.half_view));
  return edge - bearing;
}

/// The edge of the view, for a landmark (phi, r) on a ring about its anchor: as the bearing of a point p =
/// anchor + r (cos phi, sin phi), d/dp = (-u_y, u_x) / |p - sensor|.
template <class T>
HWY_INLINE Measured1<T> measure_edge(const LandmarkMeasurement& z, const SensorMount& mount,
                                     const Sensor<T>& from, const Gaussian2<T>& m, T ax, T ay) {
  const auto phi = sin_cos(m.a);
  const Ray<T> ray = ray_of(ax - from.x + m.b * phi.cos, ay - from.y + m.b * phi.sin);
  const T tx = -ray.uy * ray.inverse_r;
  const T ty = ray.ux * ray.inverse_r;
  return {edge_innovation(mount, from, ray),
          T(z.R_bb),
          m.b * (ty * phi.cos - tx * phi.sin),
          tx * phi.cos + ty * phi.sin,
          -tx,
          -ty,
          tx * from.arm_y - ty * from.arm_x - T(1.0F)};
}

/// What a sensor sees from a robot that moves by an increment, it sees from before if it sits at the end of
/// it.
HWY_INLINE LandmarkObservation carried(const LandmarkObservation& observation, const Increment& d) {
  LandmarkObservation s = observation;
  const float c = std::cos(d.t);
  const float sine = std::sin(d.t);
  const auto turn = [c, sine](float& x, float& y) HWY_ATTR {
    const float turned = c * x - sine * y;
    y = sine * x + c * y;
    x = turned;
  };
  turn(s.mount.x, s.mount.y);
  turn(s.mount.cos_yaw, s.mount.sin_yaw);
  turn(s.seen.cos_bearing, s.seen.sin_bearing);
  s.mount.x += d.x;
  s.mount.y += d.y;
  return s;
}

template <class T>
struct Updated {
  Gaussian2<T> m;
  T log_likelihood;  ///< log N(nu; 0, Z) but for its constant
};

/// The EKF update of a point by range and bearing. With e = (nu_a, nu_t) and all in the frame of the ray,
///     Z = Sigma + R,   m' = m + Sigma Z^-1 e,   Sigma' = (det R Sigma + det Sigma R) / det Z.
/// The last is (I - K H) Sigma as 2x2 matrices allow it to be written: a sum of positive terms, which stays
/// positive however sharp the sensor.
template <class T>
HWY_INLINE Updated<T> update2(const Measured2<T>& l, const Gaussian2<T>& m) {
  const RayCovariance<T> S = along_ray(l, m);
  const T Z_aa = S.aa + l.R_aa;
  const T Z_at = S.at + l.R_at;
  const T Z_tt = S.tt + l.R_tt;
  const T det_Z = Z_aa * Z_tt - Z_at * Z_at;
  const T factor = inverse(det_Z);
  const T f_a = (Z_tt * l.nu_a - Z_at * l.nu_t) * factor;
  const T f_t = (Z_aa * l.nu_t - Z_at * l.nu_a) * factor;
  const T step_a = S.aa * f_a + S.at * f_t;
  const T step_t = S.at * f_a + S.tt * f_t;

  const T part_m = (l.R_aa * l.R_tt - l.R_at * l.R_at) * factor;
  const T part_R = determinant(m) * factor;
  const T xx = l.ray.ux * l.ray.ux;
  const T xy = l.ray.ux * l.ray.uy;
  const T yy = l.ray.uy * l.ray.uy;
  const T two_xy_R = T(2.0F) * xy * l.R_at;
  return {{m.a + l.ray.ux * step_a - l.ray.uy * step_t, m.b + l.ray.uy * step_a + l.ray.ux * step_t,
           part_m * m.aa + part_R * (xx * l.R_aa - two_xy_R + yy * l.R_tt),
           part_m * m.ab + part_R * (xy * (l.R_aa - l.R_tt) + (xx - yy) * l.R_at),
           part_m * m.bb + part_R * (yy * l.R_aa + two_xy_R + xx * l.R_tt)},
          // Francisco (7)
          T(-0.5F) * (l.nu_a * f_a + l.nu_t * f_t + logarithm(det_Z * l.ray.inverse_r * l.ray.inverse_r))};
}

/// The EKF update of any landmark by one number. With h its derivative, S = h Sigma h^T + R and h' = h turned
/// by a quarter, Sigma' = (R Sigma + det Sigma h'^T h') / S: positive terms again.
template <class T>
HWY_INLINE Updated<T> update1(const Measured1<T>& l, const Gaussian2<T>& m) {
  const T s_a = m.aa * l.h_a + m.ab * l.h_b;
  const T s_b = m.ab * l.h_a + m.bb * l.h_b;
  const T S = l.h_a * s_a + l.h_b * s_b + l.R;
  const T factor = inverse(S);
  const T f = l.nu * factor;
  const T part_m = l.R * factor;
  const T part_h = determinant(m) * factor;
  return {{m.a + s_a * f, m.b + s_b * f, part_m * m.aa + part_h * l.h_b * l.h_b,
           part_m * m.ab - part_h * l.h_a * l.h_b, part_m * m.bb + part_h * l.h_a * l.h_a},
          T(-0.5F) * (l.nu * f + logarithm(S))};  // Francisco (7)
}

/// P g for a row g of three.
template <class T>
struct Column3 {
  T x, y, t;
};

template <class T>
HWY_INLINE Column3<T> times(const Gaussian3<T>& d, const Column3<T>& g) {
  return {d.xx * g.x + d.xy * g.y + d.xt * g.t, d.xy * g.x + d.yy * g.y + d.yt * g.t,
          d.xt * g.x + d.yt * g.y + d.tt * g.t};
}

template <class T>
HWY_INLINE T dot(const Column3<T>& a, const Column3<T>& b) {
  return a.x * b.x + a.y * b.y + a.t * b.t;
}

/// A row in the world's axes, in those of the robot before it moved.
template <class T>
HWY_INLINE Column3<T> in_frame_of(const Pose<T>& before, T g_x, T g_y, T g_t) {
  return {before.c * g_x + before.s * g_y, before.c * g_y - before.s * g_x, g_t};
}

template <class T>
struct Conditioned {
  Gaussian3<T> d;
  T log_likelihood;
};

/// The increment, given one observation (Montemerlo et al. 2003): with row g, P_g = P g^T and L = g P_g +
/// Z, mu += P_g / L nu, P -= P_g P_g^T / L.
template <class T>
HWY_INLINE Conditioned<T> condition1(const Gaussian3<T>& d, const Column3<T>& g, T nu, T Z) {
  const Column3<T> p = times(d, g);
  const T L = dot(g, p) + Z;
  const T factor = inverse(L);
  const T f = nu * factor;
  const Column3<T> k{p.x * factor, p.y * factor, p.t * factor};
  return {{d.x + p.x * f, d.y + p.y * f, d.t + p.t * f, d.xx - k.x * p.x, d.xy - k.x * p.y, d.xt - k.x * p.t,
           d.yy - k.y * p.y, d.yt - k.y * p.t, d.tt - k.t * p.t},
          T(-0.5F) * (nu * f + logarithm(L))};  // Francisco (7)
}

/// The derivatives of range and bearing with respect to the robot's increment, as rows.
template <class T>
struct Rows2 {
  Column3<T> a, t;
};

template <class T>
HWY_INLINE Rows2<T> rows_of(const Measured2<T>& l, const Sensor<T>& from, const Pose<T>& before) {
  const T turn_a = l.ray.ux * from.arm_y - l.ray.uy * from.arm_x;
  const T turn_t = -(l.ray.uy * from.arm_y + l.ray.ux * from.arm_x) - l.ray.r;
  return {in_frame_of(before, -l.ray.ux, -l.ray.uy, turn_a),
          in_frame_of(before, l.ray.uy, -l.ray.ux, turn_t)};
}

/// The covariance L of a range-bearing innovation when the increment is still open, in the frame of the ray.
template <class T>
HWY_INLINE RayCovariance<T> innovation_covariance(const Measured2<T>& l, const Gaussian2<T>& m,
                                                  const Rows2<T>& g, const Column3<T>& p_a,
                                                  const Column3<T>& p_t) {
  const RayCovariance<T> S = along_ray(l, m);
  return {dot(g.a, p_a) + S.aa + l.R_aa, dot(g.a, p_t) + S.at + l.R_at, dot(g.t, p_t) + S.tt + l.R_tt};
}

template <class T>
HWY_INLINE Conditioned<T> condition2(const Gaussian3<T>& d, const Rows2<T>& g, const Measured2<T>& l,
                                     const Gaussian2<T>& m) {
  const Column3<T> p = times(d, g.a);
  const Column3<T> q = times(d, g.t);
  const RayCovariance<T> L = innovation_covariance(l, m, g, p, q);
  const T det_L = L.aa * L.tt - L.at * L.at;
  const T factor = inverse(det_L);
  const T f_a = (L.tt * l.nu_a - L.at * l.nu_t) * factor;
  const T f_t = (L.aa * l.nu_t - L.at * l.nu_a) * factor;
  const auto gain = [&](T p_i, T q_i) HWY_ATTR {
    return Column3<T>{(L.tt * p_i - L.at * q_i) * factor, (L.aa * q_i - L.at * p_i) * factor, T(0.0F)};
  };
  const Column3<T> kx = gain(p.x, q.x);
  const Column3<T> ky = gain(p.y, q.y);
  const Column3<T> kt = gain(p.t, q.t);
  return {{d.x + p.x * f_a + q.x * f_t, d.y + p.y * f_a + q.y * f_t, d.t + p.t * f_a + q.t * f_t,
           d.xx - kx.x * p.x - kx.y * q.x, d.xy - kx.x * p.y - kx.y * q.y, d.xt - kx.x * p.t - kx.y * q.t,
           d.yy - ky.x * p.y - ky.y * q.y, d.yt - ky.x * p.t - ky.y * q.t, d.tt - kt.x * p.t - kt.y * q.t},
          // Francisco (7)
          T(-0.5F) * (l.nu_a * f_a + l.nu_t * f_t + logarithm(det_L * l.ray.inverse_r * l.ray.inverse_r))};
}

/// mu + L n with P = L L^T, for a covariance of any rank: vanishing pivots count as 0.
template <class T>
HWY_INLINE Column3<T> draw_from(const Gaussian3<T>& d, T n0, T n1, T n2) {
  // 1 / sqrt of a pivot, or 0.
  const auto inverse_of = [](T pivot, T began) HWY_ATTR {
    const T root = inverse_root(larger(pivot, T(1e-36F)));
    return where_less(T(kRelativePivot) * began, pivot, root, T(0.0F));
  };
  const T x = inverse_of(d.xx, d.xx);
  const T yx = d.xy * x;
  const T tx = d.xt * x;
  const T pivot_y = d.yy - yx * yx;
  const T y = inverse_of(pivot_y, d.yy);
  const T ty = (d.yt - tx * yx) * y;
  const T pivot_t = d.tt - tx * tx - ty * ty;
  const T t = inverse_of(pivot_t, d.tt);
  return {d.x + d.xx * x * n0, d.y + yx * n0 + pivot_y * y * n1, d.t + tx * n0 + ty * n1 + pivot_t * t * n2};
}

}  // namespace waymark::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
