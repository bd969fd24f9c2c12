#include "waymark/kernels/symmetric_update.hpp"

#include <algorithm>
#include <cmath>

#include "waymark/kernels/highway_targets.hpp"
#include "waymark/kernels/layout.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "waymark/kernels/symmetric_update.cpp"
#include <hwy/cache_control.h>
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace waymark::kernels::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// The compressed terms of a tile, one row of operands and one broadcast fill the registers (32 or 16), and
// are enough independent chains to hide the latency of a fused multiply-add. Per step of k a tile of 8 x 3
// vectors loads 11 operands for 24 multiply-adds, so arithmetic and not the load ports is the bound: n^2 D
// flop at peak rate.
#if HWY_TARGET <= HWY_AVX3 || HWY_TARGET == HWY_NEON
constexpr std::size_t kTileRows = 8, kTileVectors = 3;
#else
constexpr std::size_t kTileRows = 4, kTileVectors = 3;
#endif

// Rows of P that share a panel of B, D rows by one tile's width, so that it comes into L1 once for all of
// them. Fewer would fetch B more often, more would be more streams through P than the hardware prefetcher
// follows.
constexpr std::size_t kRowBlock = 24;

constexpr hn::ScalableTag<double> kTag;
using Vector = hn::Vec<decltype(kTag)>;

// P -= A^T B, on the upper triangle only or on whole rows.
struct Update {
  double* P;
  std::size_t ld;
  const double* A;
  std::size_t lda;
  const double* B;
  std::size_t ldb, D;
  const double *d = nullptr, *e = nullptr;  // null without a shear
  bool triangle = true;
};

// The change of kRows rows by kVectors vectors of P.
template <std::size_t kRows, std::size_t kVectors>
struct Tile {
  Vector sum[kRows][kVectors];

  HWY_INLINE void clear() {
    for (auto& row : sum)
      for (Vector& s : row) s = hn::Zero(kTag);
  }

  HWY_INLINE void add_to(double* P, std::size_t ld) const {
    for (std::size_t r = 0; r < kRows; ++r) {
      for (std::size_t v = 0; v < kVectors; ++v) {
        double* const p = P + r * ld + v * hn::Lanes(kTag);
        hn::Store(hn::Add(hn::Load(kTag, p), sum[r][v]), kTag, p);
      }
    }
  }

  // += or -= the outer product of kRows values at `left` and the tile's width of values at `right`.
  template <bool kSubtract>
  HWY_INLINE void add_outer(const double* left, const double* right) {
    Vector w[kVectors];
    for (std::size_t v = 0; v < kVectors; ++v) w[v] = hn::Load(kTag, right + v * hn::Lanes(kTag));
    for (std::size_t r = 0; r < kRows; ++r) {
      const Vector factor = hn::Set(kTag, left[r]);
      for (std::size_t v = 0; v < kVectors; ++v)
        sum[r][v] = kSubtract ? hn::NegMulAdd(factor, w[v], sum[r][v]) : hn::MulAdd(factor, w[v], sum[r][v]);
    }
  }
};

// The tile to the right is worked on after the other row tiles of this block: time to fetch it from L3.
template <std::size_t kRows, std::size_t kVectors>
HWY_INLINE void prefetch_right(const double* P, std::size_t ld) {
  constexpr std::size_t kWidth = kVectors * hn::MaxLanes(kTag);
  for (std::size_t r = 0; r < kRows; ++r)
    for (std::size_t j = kWidth; j < 2 * kWidth; j += kBlock) hwy::Prefetch(P + r * ld + j);
}

template <std::size_t kRows, std::size_t kVectors>
HWY_INLINE void update_tile(const Update& u, std::size_t i, std::size_t j) {
  double* const P = u.P + i * u.ld + j;
  Tile<kRows, kVectors> tile;
  tile.clear();
  prefetch_right<kRows, kVectors>(P, u.ld);
  const double* A = u.A;
  const double* B = u.B;
  for (std::size_t k = 0; k < u.D; ++k, A += u.lda, B += u.ldb) {
    tile.template add_outer<true>(A + i, B + j);
  }
  if (u.d != nullptr) {
    tile.template add_outer<false>(u.d + i, u.e + j);
    tile.template add_outer<false>(u.e + i, u.d + j);
  }
  tile.add_to(P, u.ld);  // only now: the sums of this tile and the next need not wait for P
}

// A tile cut short by the diagonal or the right edge has fewer vectors.
template <std::size_t kRows, std::size_t kVectors = kTileVectors>
HWY_INLINE void update_tile(const Update& u, std::size_t i, std::size_t j, std::size_t vectors) {
  if (vectors == kVectors) return update_tile<kRows, kVectors>(u, i, j);
  if constexpr (kVectors > 1) update_tile<kRows, kVectors - 1>(u, i, j, vectors);
}

// The first column of row i to be worked on: whole blocks.
HWY_INLINE std::size_t first_column(const Update& u, std::size_t i) { return u.triangle ? round_down(i) : 0; }

// What of columns [left, right) of rows [top, bottom) is to be worked on.
HWY_INLINE void update_panel(const Update& u, std::size_t top, std::size_t bottom, std::size_t left,
                             std::size_t right) {
  for (std::size_t i = top; i < bottom && first_column(u, i) < right;) {
    const std::size_t j = std::max(left, first_column(u, i));
    const std::size_t vectors = (right - j) / hn::Lanes(kTag);
    if (i % kTileRows == 0 && i + kTileRows <= bottom) {
      update_tile<kTileRows>(u, i, j, vectors);
      i += kTileRows;
    } else {
      update_tile<1>(u, i, j, vectors);
      i += 1;
    }
  }
}

void update_rows(const Update& u, std::size_t n, RowBand band) {
  const std::size_t width = kTileVectors * hn::Lanes(kTag);
  for (std::size_t top = band.begin; top < band.end;) {
    const std::size_t bottom = std::min(band.end, top - top % kRowBlock + kRowBlock);
    for (std::size_t left = first_column(u, top); left < round_up(n); left += width)
      update_panel(u, top, bottom, left, std::min(left + width, round_up(n)));
    top = bottom;
  }
}

void update_band(double* P, std::size_t ld, std::size_t n, const double* A, const double* B, std::size_t ldw,
                 std::size_t D, const double* d, const double* e, RowBand band) {
  update_rows({P, ld, A, ldw, B, ldw, D, d, e}, n, band);
}

void subtract_rows(double* P, std::size_t ld, std::size_t n, const double* A, std::size_t lda,
                   const double* B, std::size_t ldb, std::size_t D, RowBand band) {
  update_rows({P, ld, A, lda, B, ldb, D, nullptr, nullptr, false}, n, band);
}

}  // namespace waymark::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace waymark::kernels {

HWY_EXPORT(update_band);
HWY_EXPORT(subtract_rows);

RowBand triangle_band(std::size_t n, std::size_t index, std::size_t count) {
  // The rows [0, i) hold 1 - (1 - i/n)^2 of the area.
  const auto cut = [n, count](std::size_t k) {
    if (k >= count) return n;
    const double rest = std::sqrt(1.0 - static_cast<double>(k) / static_cast<double>(count));
    return round_down(static_cast<std::size_t>(static_cast<double>(n) * (1.0 - rest)));
  };
  return {cut(index), cut(index + 1)};
}

void symmetric_downdate(double* P, std::size_t ld, std::size_t n, const double* W, std::size_t ldw,
                        std::size_t D, RowBand band) {
  HWY_DYNAMIC_DISPATCH(update_band)(P, ld, n, W, W, ldw, D, nullptr, nullptr, band);
}

void symmetric_update(double* P, std::size_t ld, std::size_t n, const double* W, std::size_t ldw,
                      std::size_t D, const double* d, const double* e, RowBand band) {
  HWY_DYNAMIC_DISPATCH(update_band)(P, ld, n, W, W, ldw, D, d, e, band);
}

void symmetric_product_update(double* P, std::size_t ld, std::size_t n, const double* A, const double* B,
                              std::size_t ldw, std::size_t D, const double* d, const double* e,
                              RowBand band) {
  HWY_DYNAMIC_DISPATCH(update_band)(P, ld, n, A, B, ldw, D, d, e, band);
}

void subtract_product(double* P, std::size_t ld, std::size_t n, const double* A, std::size_t lda,
                      const double* B, std::size_t ldb, std::size_t D, RowBand band) {
  HWY_DYNAMIC_DISPATCH(subtract_rows)(P, ld, n, A, lda, B, ldb, D, band);
}

namespace reference {

void symmetric_update(double* P, std::size_t ld, std::size_t n, const double* W, std::size_t ldw,
                      std::size_t D, const double* d, const double* e) {
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = i; j < n; ++j) {
      double& p = P[i * ld + j];
      for (std::size_t k = 0; k < D; ++k) p -= W[k * ldw + i] * W[k * ldw + j];
      if (d != nullptr) p += d[i] * e[j] + e[i] * d[j];
    }
  }
}

}  // namespace reference
}  // namespace waymark::kernels
#endif
