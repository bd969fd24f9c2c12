#include "waymark/kernels/triangular_solve.hpp"

#include "waymark/kernels/highway_targets.hpp"
#include "waymark/kernels/layout.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "waymark/kernels/triangular_solve.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace waymark::kernels::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Tiles of kTileRows unknowns by kTileVectors vectors of columns: every solved row that is loaded serves all
// rows of the tile. The panel of W above the tile, D rows by a few lines, stays in L1.
#if HWY_TARGET <= HWY_AVX3 || HWY_TARGET == HWY_NEON
constexpr std::size_t kTileRows = 4, kTileVectors = 4;
#else
constexpr std::size_t kTileRows = 4, kTileVectors = 2;
#endif

constexpr hn::ScalableTag<double> kTag;
using Vector = hn::Vec<decltype(kTag)>;

struct Triangle {
  const double* L;
  std::size_t ldl, D;
};

template <std::size_t kVectors>
HWY_INLINE void load(const double* W, Vector (&w)[kVectors]) {
  for (std::size_t v = 0; v < kVectors; ++v) w[v] = hn::Load(kTag, W + v * hn::Lanes(kTag));
}

// row -= factor * solved
template <std::size_t kVectors>
HWY_INLINE void eliminate(double factor, const Vector (&solved)[kVectors], Vector (&row)[kVectors]) {
  for (std::size_t v = 0; v < kVectors; ++v) row[v] = hn::NegMulAdd(hn::Set(kTag, factor), solved[v], row[v]);
}

// Unknowns `first` .. first + kRows - 1, when those before are solved.
template <std::size_t kRows, std::size_t kVectors>
HWY_INLINE void solve_tile(const Triangle& t, std::size_t first, double* W, std::size_t ldw) {
  const double* L = t.L + first * t.ldl;
  Vector rows[kRows][kVectors];
  for (std::size_t r = 0; r < kRows; ++r) load(W + (first + r) * ldw, rows[r]);
  for (std::size_t k = 0; k < first; ++k) {
    Vector solved[kVectors];
    load(W + k * ldw, solved);
    for (std::size_t r = 0; r < kRows; ++r) eliminate(L[r * t.ldl + k], solved, rows[r]);
  }
  for (std::size_t s = 0; s < kRows; ++s) {
    const Vector inverse = hn::Set(kTag, 1.0 / L[s * t.ldl + first + s]);
    for (std::size_t v = 0; v < kVectors; ++v) {
      rows[s][v] = hn::Mul(rows[s][v], inverse);
      hn::Store(rows[s][v], kTag, W + (first + s) * ldw + v * hn::Lanes(kTag));
    }
    for (std::size_t r = s + 1; r < kRows; ++r) eliminate(L[r * t.ldl + first + s], rows[s], rows[r]);
  }
}

template <std::size_t kVectors>
HWY_INLINE void solve_panel(const Triangle& t, double* W, std::size_t ldw) {
  std::size_t first = 0;
  for (; first + kTileRows <= t.D; first += kTileRows) solve_tile<kTileRows, kVectors>(t, first, W, ldw);
  for (; first < t.D; ++first) solve_tile<1, kVectors>(t, first, W, ldw);
}

void solve(const double* L, std::size_t ldl, std::size_t D, double* W, std::size_t ldw, std::size_t n) {
  const Triangle t{L, ldl, D};
  const std::size_t lanes = hn::Lanes(kTag);
  const std::size_t width = kTileVectors * lanes;
  std::size_t j = 0;
  for (; j + width <= round_up(n); j += width) solve_panel<kTileVectors>(t, W + j, ldw);
  for (; j < round_up(n); j += lanes) solve_panel<1>(t, W + j, ldw);
}

}  // namespace waymark::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace waymark::kernels {

HWY_EXPORT(solve);

void triangular_solve(const double* L, std::size_t ldl, std::size_t D, double* W, std::size_t ldw,
                      std::size_t n) {
  HWY_DYNAMIC_DISPATCH(solve)(L, ldl, D, W, ldw, n);
}

namespace reference {

void triangular_solve(const double* L, std::size_t ldl, std::size_t D, double* W, std::size_t ldw,
                      std::size_t n) {
  for (std::size_t i = 0; i < D; ++i) {
    for (std::size_t j = 0; j < n; ++j) {
      double w = W[i * ldw + j];
      for (std::size_t k = 0; k < i; ++k) w -= L[i * ldl + k] * W[k * ldw + j];
      W[i * ldw + j] = w / L[i * ldl + i];
    }
  }
}

}  // namespace reference
}  // namespace waymark::kernels
#endif
