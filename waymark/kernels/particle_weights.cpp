#include "waymark/kernels/particle_weights.hpp"

#include <cmath>
#include <limits>
#include <numbers>

#include "waymark/kernels/highway_targets.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "waymark/kernels/particle_weights.cpp"
// foreach_target.h must come before what is compiled once per target.
// clang-format off
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
#include <hwy/contrib/math/math-inl.h>
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace waymark::kernels::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

constexpr double kNever = -std::numeric_limits<double>::infinity();

constexpr hn::ScalableTag<double> kTag;
using Vector = hn::Vec<decltype(kTag)>;
using Mask = hn::Mask<decltype(kTag)>;

// Entries i, i + 1, ... that are not padding.
HWY_INLINE Mask inside(std::size_t i, std::size_t count) { return hn::FirstN(kTag, count - i); }

HWY_INLINE Mask is_number(Vector x) { return hn::IsFinite(x); }

double largest(const double* log_weight, std::size_t count) {
  const Vector never = hn::Set(kTag, kNever);
  Vector best = never;
  for (std::size_t i = 0; i < count; i += hn::Lanes(kTag)) {
    const Vector x = hn::Load(kTag, log_weight + i);
    best = hn::Max(best, hn::IfThenElse(hn::And(is_number(x), inside(i, count)), x, never));
  }
  return hn::GetLane(hn::MaxOfLanes(kTag, best));
}

double exponentiate_lanes(double shift, double* log_weight, double* weight, std::size_t count) {
  const Vector never = hn::Set(kTag, kNever);
  Vector sum = hn::Zero(kTag);
  for (std::size_t i = 0; i < count; i += hn::Lanes(kTag)) {
    const Vector x = hn::Sub(hn::Load(kTag, log_weight + i), hn::Set(kTag, shift));
    const Mask counts = hn::And(is_number(x), inside(i, count));
    const Vector w = hn::IfThenElseZero(counts, hn::Exp(kTag, hn::IfThenElseZero(counts, x)));
    hn::Store(hn::IfThenElse(counts, x, never), kTag, log_weight + i);
    hn::Store(w, kTag, weight + i);
    sum = hn::Add(sum, w);
  }
  return hn::GetLane(hn::SumOfLanes(kTag, sum));
}

void sum_powers_lanes(const double* log_weight, double power, std::size_t count, double* sums) {
  Vector sum = hn::Zero(kTag);
  Vector squares = hn::Zero(kTag);
  for (std::size_t i = 0; i < count; i += hn::Lanes(kTag)) {
    const Vector x = hn::Load(kTag, log_weight + i);
    const Mask counts = hn::And(is_number(x), inside(i, count));
    const Vector exponent = hn::Mul(hn::IfThenElseZero(counts, x), hn::Set(kTag, power));
    const Vector w = hn::IfThenElseZero(counts, hn::Exp(kTag, exponent));
    sum = hn::Add(sum, w);
    squares = hn::MulAdd(w, w, squares);
  }
  sums[0] = hn::GetLane(hn::SumOfLanes(kTag, sum));
  sums[1] = hn::GetLane(hn::SumOfLanes(kTag, squares));
}

void scale_lanes(double factor, double* values, std::size_t count) {
  for (std::size_t i = 0; i < count; i += hn::Lanes(kTag))
    hn::Store(hn::Mul(hn::Load(kTag, values + i), hn::Set(kTag, factor)), kTag, values + i);
}

HWY_INLINE Vector difference(const double* values, std::size_t i, double reference) {
  return hn::Sub(hn::Load(kTag, values + i), hn::Set(kTag, reference));
}

HWY_INLINE Vector wrapped(Vector angle) {
  const Vector turns = hn::Round(hn::Mul(angle, hn::Set(kTag, 0.5 * std::numbers::inv_pi)));
  return hn::NegMulAdd(turns, hn::Set(kTag, 2.0 * std::numbers::pi), angle);
}

void sum_poses_lanes(const WorldPoses& world, const double* weight, const double* reference,
                     std::size_t count, double* sums) {
  Vector terms[10];
  for (auto& term : terms) term = hn::Zero(kTag);
  for (std::size_t i = 0; i < count; i += hn::Lanes(kTag)) {
    const Vector w = hn::IfThenElseZero(inside(i, count), hn::Load(kTag, weight + i));
    const Vector x = difference(world.x_m, i, reference[0]);
    const Vector y = difference(world.y_m, i, reference[1]);
    const Vector t = wrapped(difference(world.theta_rad, i, reference[2]));
    const Vector wx = hn::Mul(w, x);
    const Vector wy = hn::Mul(w, y);
    const Vector wt = hn::Mul(w, t);
    terms[0] = hn::Add(terms[0], w);
    terms[1] = hn::Add(terms[1], wx);
    terms[2] = hn::Add(terms[2], wy);
    terms[3] = hn::Add(terms[3], wt);
    terms[4] = hn::MulAdd(wx, x, terms[4]);
    terms[5] = hn::MulAdd(wx, y, terms[5]);
    terms[6] = hn::MulAdd(wx, t, terms[6]);
    terms[7] = hn::MulAdd(wy, y, terms[7]);
    terms[8] = hn::MulAdd(wy, t, terms[8]);
    terms[9] = hn::MulAdd(wt, t, terms[9]);
  }
  for (std::size_t k = 0; k < 10; ++k) sums[k] = hn::GetLane(hn::SumOfLanes(kTag, terms[k]));
}

}  // namespace waymark::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace waymark::kernels {

HWY_EXPORT(largest);
HWY_EXPORT(exponentiate_lanes);
HWY_EXPORT(sum_powers_lanes);
HWY_EXPORT(scale_lanes);
HWY_EXPORT(sum_poses_lanes);

double largest_finite(const double* log_weight, std::size_t count) {
  return HWY_DYNAMIC_DISPATCH(largest)(log_weight, count);
}

double exponentiate(double largest, double* log_weight, double* weight, std::size_t count) {
  return HWY_DYNAMIC_DISPATCH(exponentiate_lanes)(largest, log_weight, weight, count);
}

std::array<double, 2> sum_powers(const double* log_weight, double power, std::size_t count) {
  std::array<double, 2> sums{};
  HWY_DYNAMIC_DISPATCH(sum_powers_lanes)(log_weight, power, count, sums.data());
  return sums;
}

void scale(double factor, double* values, std::size_t count) {
  HWY_DYNAMIC_DISPATCH(scale_lanes)(factor, values, count);
}

PoseSums sum_poses(const WorldPoses& world, const double* weight, const std::array<double, 3>& reference,
                   std::size_t count) {
  PoseSums sums{};
  HWY_DYNAMIC_DISPATCH(sum_poses_lanes)(world, weight, reference.data(), count, sums.data());
  return sums;
}

namespace reference {

double exponentiate(double largest, double* log_weight, double* weight, std::size_t count) {
  double sum = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    const double x = log_weight[i] - largest;
    log_weight[i] = std::isfinite(x) ? x : -std::numeric_limits<double>::infinity();
    weight[i] = std::exp(log_weight[i]);
    sum += weight[i];
  }
  return sum;
}

std::array<double, 2> sum_powers(const double* log_weight, double power, std::size_t count) {
  std::array<double, 2> sums{};
  for (std::size_t i = 0; i < count; ++i) {
    const double w = std::isfinite(log_weight[i]) ? std::exp(power * log_weight[i]) : 0.0;
    sums[0] += w;
    sums[1] += w * w;
  }
  return sums;
}

PoseSums sum_poses(const WorldPoses& world, const double* weight, const std::array<double, 3>& reference,
                   std::size_t count) {
  PoseSums sums{};
  for (std::size_t i = 0; i < count; ++i) {
    const double x = world.x_m[i] - reference[0];
    const double y = world.y_m[i] - reference[1];
    const double t = std::remainder(world.theta_rad[i] - reference[2], 2.0 * std::numbers::pi);
    const std::array<double, 10> terms{1.0, x, y, t, x * x, x * y, x * t, y * y, y * t, t * t};
    for (std::size_t k = 0; k < 10; ++k) sums[k] += weight[i] * terms[k];
  }
  return sums;
}

}  // namespace reference
}  // namespace waymark::kernels
#endif
