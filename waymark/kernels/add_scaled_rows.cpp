#include "waymark/kernels/add_scaled_rows.hpp"

#include "waymark/kernels/highway_targets.hpp"
#include "waymark/kernels/layout.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "waymark/kernels/add_scaled_rows.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace waymark::kernels::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

constexpr hn::ScalableTag<double> kTag;

// Every element of W is used once, so reading W is the bound; x stays in registers and is written once.
template <std::size_t kVectors>
HWY_INLINE void add_panel(double* x, const double* W, std::size_t ldw, std::size_t D, const double* y) {
  const std::size_t lanes = hn::Lanes(kTag);
  hn::Vec<decltype(kTag)> sum[kVectors];
  for (std::size_t v = 0; v < kVectors; ++v) sum[v] = hn::Load(kTag, x + v * lanes);
  for (std::size_t k = 0; k < D; ++k, W += ldw) {
    const auto factor = hn::Set(kTag, y[k]);
    for (std::size_t v = 0; v < kVectors; ++v)
      sum[v] = hn::MulAdd(factor, hn::Load(kTag, W + v * lanes), sum[v]);
  }
  for (std::size_t v = 0; v < kVectors; ++v) hn::Store(sum[v], kTag, x + v * lanes);
}

void add_rows(double* x, const double* W, std::size_t ldw, std::size_t D, const double* y, std::size_t n) {
  constexpr std::size_t kVectors = 4;
  const std::size_t lanes = hn::Lanes(kTag);
  std::size_t j = 0;
  for (; j + kVectors * lanes <= round_up(n); j += kVectors * lanes)
    add_panel<kVectors>(x + j, W + j, ldw, D, y);
  for (; j < round_up(n); j += lanes) add_panel<1>(x + j, W + j, ldw, D, y);
}

}  // namespace waymark::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace waymark::kernels {

HWY_EXPORT(add_rows);

void add_scaled_rows(double* x, const double* W, std::size_t ldw, std::size_t D, const double* y,
                     std::size_t n) {
  HWY_DYNAMIC_DISPATCH(add_rows)(x, W, ldw, D, y, n);
}

namespace reference {

void add_scaled_rows(double* x, const double* W, std::size_t ldw, std::size_t D, const double* y,
                     std::size_t n) {
  for (std::size_t j = 0; j < n; ++j)
    for (std::size_t k = 0; k < D; ++k) x[j] += W[k * ldw + j] * y[k];
}

}  // namespace reference
}  // namespace waymark::kernels
#endif
