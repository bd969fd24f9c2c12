// Vectors of float lanes that compute like a number: one formula, written once, is both the SIMD kernel (T =
// Lanes) and its scalar reference (T = double). Compiled once per instruction set, hence no #pragma once.
#if defined(WAYMARK_KERNELS_LANES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef WAYMARK_KERNELS_LANES_INL_H
#undef WAYMARK_KERNELS_LANES_INL_H
#else
#define WAYMARK_KERNELS_LANES_INL_H
#endif

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace waymark::kernels::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using FloatTag = hn::ScalableTag<float>;
using IntTag = hn::RebindToSigned<FloatTag>;

struct Lanes {
  hn::Vec<FloatTag> v;

  // NOLINTBEGIN(google-explicit-constructor): a number in a formula is the same number in every lane
  HWY_INLINE Lanes(hn::Vec<FloatTag> vector) : v(vector) {}
  HWY_INLINE Lanes(float value) : v(hn::Set(FloatTag(), value)) {}
  HWY_INLINE Lanes(double value) : Lanes(static_cast<float>(value)) {}
  // NOLINTEND(google-explicit-constructor)
};

HWY_INLINE std::size_t lane_count() { return hn::Lanes(FloatTag()); }

HWY_INLINE Lanes operator+(Lanes a, Lanes b) { return hn::Add(a.v, b.v); }
HWY_INLINE Lanes operator-(Lanes a, Lanes b) { return hn::Sub(a.v, b.v); }
HWY_INLINE Lanes operator*(Lanes a, Lanes b) { return hn::Mul(a.v, b.v); }
HWY_INLINE Lanes operator/(Lanes a, Lanes b) { return hn::Div(a.v, b.v); }
HWY_INLINE Lanes operator-(Lanes a) { return hn::Neg(a.v); }

HWY_INLINE Lanes larger(Lanes a, Lanes b) { return hn::Max(a.v, b.v); }
HWY_INLINE double larger(double a, double b) { return std::max(a, b); }

/// a < b ? x : y
HWY_INLINE Lanes where_less(Lanes a, Lanes b, Lanes x, Lanes y) {
  return hn::IfThenElse(hn::Lt(a.v, b.v), x.v, y.v);
}
HWY_INLINE double where_less(double a, double b, double x, double y) { return a < b ? x : y; }

HWY_INLINE Lanes square_root(Lanes x) { return hn::Sqrt(x.v); }
HWY_INLINE double square_root(double x) { return std::sqrt(x); }

/// 1/x and 1/sqrt(x) of positive normal numbers, 2 ulp. Where the processor estimates them to 12 bits or
/// more, one step of Newton's is much cheaper than a division.
#if HWY_TARGET == HWY_SCALAR || HWY_TARGET == HWY_NEON
HWY_INLINE Lanes inverse(Lanes x) { return Lanes(1.0F) / x; }
HWY_INLINE Lanes inverse_root(Lanes x) { return Lanes(1.0F) / square_root(x); }
#else
HWY_INLINE Lanes inverse(Lanes x) {
  const Lanes y = hn::ApproximateReciprocal(x.v);
  return y * (Lanes(2.0F) - x * y);
}
HWY_INLINE Lanes inverse_root(Lanes x) {
  const Lanes y = hn::ApproximateReciprocalSqrt(x.v);
  return y * (Lanes(1.5F) - x * 0.5F * y * y);
}
#endif
HWY_INLINE double inverse(double x) { return 1.0 / x; }
HWY_INLINE double inverse_root(double x) { return 1.0 / std::sqrt(x); }

HWY_INLINE Lanes absolute(Lanes x) { return hn::Abs(x.v); }
HWY_INLINE double absolute(double x) { return std::abs(x); }

/// Natural logarithm of a positive normal number (Cephes logf), 2 ulp; of 0: about -87.
HWY_INLINE Lanes logarithm(Lanes x) {
  const IntTag ints;
  const auto half_root = hn::Set(ints, 0x3F3504F3);  // the bits of sqrt(1/2)
  const auto bits = hn::BitCast(ints, x.v);
  const auto exponent = hn::ShiftRight<23>(hn::Sub(bits, half_root));
  const Lanes e = hn::ConvertTo(FloatTag(), exponent);
  const Lanes m = Lanes(hn::BitCast(FloatTag(), hn::Sub(bits, hn::ShiftLeft<23>(exponent)))) - 1.0F;
  const Lanes z = m * m;
  Lanes p = Lanes(7.0376836292e-2F) * m - 1.1514610310e-1F;
  p = p * m + 1.1676998740e-1F;
  p = p * m - 1.2420140846e-1F;
  p = p * m + 1.4249322787e-1F;
  p = p * m - 1.6668057665e-1F;
  p = p * m + 2.0000714765e-1F;
  p = p * m - 2.4999993993e-1F;
  p = p * m + 3.3333331174e-1F;
  return m + (p * m * z + e * -2.12194440e-4F - z * 0.5F) + e * 0.693359375F;
}
HWY_INLINE double logarithm(double x) { return std::log(x); }

/// e^x (Cephes expf), 2 ulp; 0 below -87.
HWY_INLINE Lanes exponential(Lanes x) {
  const Lanes clamped = hn::Clamp(x.v, hn::Set(FloatTag(), -87.0F), hn::Set(FloatTag(), 88.0F));
  const auto n = hn::NearestInt((clamped * 1.44269504088896341F).v);
  const Lanes whole = hn::ConvertTo(FloatTag(), n);
  const Lanes r = clamped - whole * 0.693359375F - whole * -2.12194440e-4F;
  Lanes p = Lanes(1.9875691500e-4F) * r + 1.3981999507e-3F;
  p = p * r + 8.3334519073e-3F;
  p = p * r + 4.1665795894e-2F;
  p = p * r + 1.6666665459e-1F;
  p = p * r + 5.0000001201e-1F;
  const Lanes mantissa = p * r * r + r + 1.0F;
  const auto scale = hn::ShiftLeft<23>(hn::Add(n, hn::Set(IntTag(), 127)));
  return where_less(x, -87.0F, 0.0F, mantissa * Lanes(hn::BitCast(FloatTag(), scale)));
}
HWY_INLINE double exponential(double x) { return std::exp(x); }

template <class T>
struct SinCos {
  T sin, cos;
};

/// Of angles up to some thousand radians (Cephes sinf and cosf), absolute error 1e-7.
HWY_INLINE SinCos<Lanes> sin_cos(Lanes angle) {
  const IntTag ints;
  const auto quadrant = hn::NearestInt((angle * 0.636619772367581343F).v);
  const Lanes q = hn::ConvertTo(FloatTag(), quadrant);
  const Lanes x = angle - q * 1.5703125F - q * 4.837512969970703125e-4F - q * 7.54978995489188216e-8F;
  const Lanes z = x * x;
  const Lanes sine = x + x * z * ((Lanes(-1.9515295891e-4F) * z + 8.3321608736e-3F) * z - 1.6666654611e-1F);
  const Lanes cosine =
      z * z * ((Lanes(2.443315711809948e-5F) * z - 1.388731625493765e-3F) * z + 4.166664568298827e-2F) -
      z * 0.5F + 1.0F;
  const auto one = hn::Set(ints, 1);
  const auto is_odd = hn::RebindMask(FloatTag(), hn::TestBit(quadrant, one));
  // Bit 1 of the quadrant, moved to the sign bit, turns the sine round; that of the next one the cosine.
  const auto sign = [&](auto n) HWY_ATTR {
    return hn::BitCast(FloatTag(), hn::ShiftLeft<30>(hn::And(n, hn::Set(ints, 2))));
  };
  return {hn::Xor(hn::IfThenElse(is_odd, cosine.v, sine.v), sign(quadrant)),
          hn::Xor(hn::IfThenElse(is_odd, sine.v, cosine.v), sign(hn::Add(quadrant, one)))};
}
HWY_INLINE SinCos<double> sin_cos(double angle) { return {std::sin(angle), std::cos(angle)}; }

/// The angle in [-pi, pi] whose sine and cosine these are, by its half: tan(angle/2) = sin / (1 + cos).
/// Absolute error 3e-7 (polynomial: Abramowitz and Stegun 4.4.49).
HWY_INLINE Lanes angle_of(Lanes sine, Lanes cosine) {
  const Lanes t = sine * inverse(absolute(cosine) + 1.0F);
  const Lanes z = t * t;
  Lanes p = Lanes(0.0028662257F) * z - 0.0161657367F;
  p = p * z + 0.0429096138F;
  p = p * z - 0.0752896400F;
  p = p * z + 0.1065626393F;
  p = p * z - 0.1420889944F;
  p = p * z + 0.1999355085F;
  p = p * z - 0.3333314528F;
  const Lanes acute = (p * z * t + t) * 2.0F;
  const Lanes half_turn = hn::CopySign(hn::Set(FloatTag(), 3.14159265358979F), sine.v);
  return where_less(cosine, 0.0F, half_turn - acute, acute);
}
HWY_INLINE double angle_of(double sine, double cosine) { return std::atan2(sine, cosine); }

/// Lane i of a column, and whole columns of lanes.
template <class T>
HWY_INLINE T load(const float* column, std::size_t i);
template <>
HWY_INLINE Lanes load<Lanes>(const float* column, std::size_t i) {
  return hn::Load(FloatTag(), column + i);
}
template <>
HWY_INLINE double load<double>(const float* column, std::size_t i) {
  return column[i];
}

HWY_INLINE void store(Lanes x, float* column, std::size_t i) { hn::Store(x.v, FloatTag(), column + i); }
HWY_INLINE void store(double x, float* column, std::size_t i) { column[i] = static_cast<float>(x); }

HWY_INLINE double sum_of(Lanes x) {
  return static_cast<double>(hn::GetLane(hn::SumOfLanes(FloatTag(), x.v)));
}
HWY_INLINE double sum_of(double x) { return x; }

/// How many entries of a column one T covers.
template <class T>
HWY_INLINE std::size_t width_of();
template <>
HWY_INLINE std::size_t width_of<Lanes>() {
  return lane_count();
}
template <>
HWY_INLINE std::size_t width_of<double>() {
  return 1;
}

}  // namespace waymark::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
