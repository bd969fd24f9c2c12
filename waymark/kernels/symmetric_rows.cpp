#include "waymark/kernels/symmetric_rows.hpp"

#include <algorithm>
#include <array>

#include "waymark/kernels/highway_targets.hpp"
#include "waymark/kernels/layout.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "waymark/kernels/symmetric_rows.cpp"
#include <hwy/cache_control.h>
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace waymark::kernels::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Columns worked on at a time: R rows of a panel stay in L1, and a panel of a strided row is enough misses at
// once.
constexpr std::size_t kPanel = 64;

struct alignas(kAlignment) Panel {
  double values[kPanel];
};

// Columns [begin, end) of row i. The strided part touches one line per element, of which the neighbouring
// rows of the same landmark then find theirs in L1; the next panel's lines are asked for meanwhile, as no
// hardware prefetcher follows so long a stride.
HWY_INLINE void gather(const double* P, std::size_t ld, std::size_t i, std::size_t begin, std::size_t end,
                       double* out) {
  const std::size_t diagonal = std::clamp(i, begin, end);
  for (std::size_t j = begin; j < diagonal; ++j) {
    if (j + kPanel < i) hwy::Prefetch(P + (j + kPanel) * ld + i);
    *out++ = P[j * ld + i];
  }
  std::copy(P + i * ld + diagonal, P + i * ld + end, out);
}

void gather_panels(const double* P, std::size_t ld, std::size_t n, std::size_t first, std::size_t count,
                   double* out, std::size_t ldo) {
  for (std::size_t begin = 0; begin < n; begin += kPanel)
    for (std::size_t r = 0; r < count; ++r)
      gather(P, ld, first + r, begin, std::min(begin + kPanel, n), out + r * ldo + begin);
}

// out = H rows for one panel: H is D x R, `columns` a multiple of kBlock.
HWY_INLINE void multiply(const double* H, std::size_t D, const double* const* rows, std::size_t R,
                         double* out, std::size_t ldo, std::size_t columns) {
  const hn::ScalableTag<double> tag;
  for (std::size_t d = 0; d < D; ++d, H += R, out += ldo) {
    for (std::size_t j = 0; j < columns; j += hn::Lanes(tag)) {
      auto sum = hn::Mul(hn::Set(tag, H[0]), hn::Load(tag, rows[0] + j));
      for (std::size_t r = 1; r < R; ++r)
        sum = hn::MulAdd(hn::Set(tag, H[r]), hn::Load(tag, rows[r] + j), sum);
      hn::Store(sum, tag, out + j);
    }
  }
}

void project(const double* P, std::size_t ld, std::size_t n, const std::size_t* rows, std::size_t R,
             const double* H, std::size_t D, double* C, std::size_t ldc) {
  std::array<Panel, kMaxRows> gathered;
  std::array<const double*, kMaxRows> sources;
  for (std::size_t begin = 0; begin < n; begin += kPanel) {
    const std::size_t end = std::min(begin + kPanel, round_up(n));
    for (std::size_t r = 0; r < R; ++r) {
      sources[r] = rows[r] <= begin ? P + rows[r] * ld + begin : gathered[r].values;
      if (rows[r] > begin) gather(P, ld, rows[r], begin, end, gathered[r].values);
    }
    multiply(H, D, sources.data(), R, C + begin, ldc, end - begin);
  }
}

void transform(double* P, std::size_t ld, std::size_t n, const double* Phi, std::size_t q) {
  std::array<Panel, kMaxRows> before;
  std::array<const double*, kMaxRows> sources;
  for (std::size_t r = 0; r < q; ++r) sources[r] = before[r].values;
  for (std::size_t begin = round_down(q); begin < n; begin += kPanel) {
    const std::size_t columns = std::min(kPanel, round_up(n) - begin);
    for (std::size_t r = 0; r < q; ++r) std::copy_n(P + r * ld + begin, columns, before[r].values);
    multiply(Phi, q, sources.data(), q, P + begin, ld, columns);
    // The first panel begins inside the leading block: put that part back.
    for (std::size_t r = 0; r < q && begin < q; ++r)
      std::copy_n(before[r].values, q - begin, P + r * ld + begin);
  }
}

}  // namespace waymark::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace waymark::kernels {

HWY_EXPORT(gather_panels);
HWY_EXPORT(project);
HWY_EXPORT(transform);

void gather_rows(const double* P, std::size_t ld, std::size_t n, std::size_t first, std::size_t count,
                 double* out, std::size_t ldo) {
  HWY_DYNAMIC_DISPATCH(gather_panels)(P, ld, n, first, count, out, ldo);
}

void project_rows(const double* P, std::size_t ld, std::size_t n, const std::size_t* rows, std::size_t R,
                  const double* H, std::size_t D, double* C, std::size_t ldc) {
  HWY_DYNAMIC_DISPATCH(project)(P, ld, n, rows, R, H, D, C, ldc);
}

void transform_leading_rows(double* P, std::size_t ld, std::size_t n, const double* Phi, std::size_t q) {
  HWY_DYNAMIC_DISPATCH(transform)(P, ld, n, Phi, q);
}

namespace reference {

void project_rows(const double* P, std::size_t ld, std::size_t n, const std::size_t* rows, std::size_t R,
                  const double* H, std::size_t D, double* C, std::size_t ldc) {
  for (std::size_t d = 0; d < D; ++d) {
    for (std::size_t j = 0; j < n; ++j) {
      double sum = 0.0;
      for (std::size_t r = 0; r < R; ++r)
        sum += H[d * R + r] * P[std::min(rows[r], j) * ld + std::max(rows[r], j)];
      C[d * ldc + j] = sum;
    }
  }
}

void transform_leading_rows(double* P, std::size_t ld, std::size_t n, const double* Phi, std::size_t q) {
  for (std::size_t j = q; j < n; ++j) {
    std::array<double, kMaxRows> column{};
    for (std::size_t r = 0; r < q; ++r)
      for (std::size_t k = 0; k < q; ++k) column[r] += Phi[r * q + k] * P[k * ld + j];
    for (std::size_t r = 0; r < q; ++r) P[r * ld + j] = column[r];
  }
}

}  // namespace reference
}  // namespace waymark::kernels
#endif
