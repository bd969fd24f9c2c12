// Philox on vectors: the random numbers of core/random.hpp, many at once. Compiled once per instruction set,
// hence no #pragma once.
#if defined(WAYMARK_KERNELS_PHILOX_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef WAYMARK_KERNELS_PHILOX_INL_H
#undef WAYMARK_KERNELS_PHILOX_INL_H
#else
#define WAYMARK_KERNELS_PHILOX_INL_H
#endif

#include <cstdint>

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace waymark::kernels::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Random numbers of many counters at once.
using WordTag = hn::ScalableTag<std::uint32_t>;
using Words = hn::Vec<WordTag>;

/// The high and low words of products of all lanes, from those of the even and the odd ones.
struct Product {
  Words high, low;
};

#if HWY_TARGET == HWY_SCALAR
HWY_INLINE Product multiply_wide(Words a, std::uint32_t b) {
  const std::uint64_t p = std::uint64_t{hn::GetLane(a)} * b;
  return {hn::Set(WordTag(), static_cast<std::uint32_t>(p >> 32)),
          hn::Set(WordTag(), static_cast<std::uint32_t>(p))};
}
#else
HWY_INLINE Product multiply_wide(Words a, std::uint32_t b) {
  const WordTag words;
  const hn::Repartition<std::uint64_t, WordTag> wide;
  const auto factor = hn::Set(words, b);
  const auto even = hn::MulEven(a, factor);
  const auto odd = hn::MulEven(hn::BitCast(words, hn::ShiftRight<32>(hn::BitCast(wide, a))), factor);
  return {hn::OddEven(hn::BitCast(words, odd), hn::BitCast(words, hn::ShiftRight<32>(even))),
          hn::OddEven(hn::BitCast(words, hn::ShiftLeft<32>(odd)), hn::BitCast(words, even))};
}
#endif

/// A counter, or the random words that come of it.
struct PhiloxWords {
  Words w0, w1, w2, w3;
};

/// Philox4x32-10 (Salmon, Moraes, Dror, Shaw 2011), the function of core/random.hpp.
HWY_INLINE PhiloxWords philox(PhiloxWords c, std::uint64_t seed) {
  const WordTag words;
  auto key0 = static_cast<std::uint32_t>(seed);
  auto key1 = static_cast<std::uint32_t>(seed >> 32);
  for (int round = 0; round < 10; ++round) {
    const Product p0 = multiply_wide(c.w0, 0xD2511F53U);
    const Product p1 = multiply_wide(c.w2, 0xCD9E8D57U);
    c = {hn::Xor(hn::Xor(p1.high, c.w1), hn::Set(words, key0)), p1.low,
         hn::Xor(hn::Xor(p0.high, c.w3), hn::Set(words, key1)), p0.low};
    key0 += 0x9E3779B9U;
    key1 += 0xBB67AE85U;
  }
  return c;
}

}  // namespace waymark::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // WAYMARK_KERNELS_PHILOX_INL_H
