#pragma once

#include <cstddef>

/// SIMD kernels, chosen at run time by what the processor has.
///
/// How the covariance kernels see memory:
/// * P, a symmetric n x n covariance: element (i, j) with j >= i is P[i * ld + j]; the lower triangle is
/// never read.
/// * C and W, D x n row panels (one row per measurement dimension): element (k, j) is W[k * ldw + j].
///
/// Strides are multiples of kBlock and rows start on kAlignment bytes, so that kernels work on whole aligned
/// blocks of kBlock columns. Hence two places may be overwritten with meaningless values: entries below the
/// diagonal inside the diagonal's own block, and the padding columns from n to round_up(n) of a row that is
/// written. Zero a buffer before its first use: then what is meaningless stays finite.
///
/// Every element is computed by the same operations in the same order wherever tiles and bands are cut and
/// however wide the vectors are: machines with fused multiply-add (AVX2, AVX-512, NEON) all give the same
/// bits, those without it round once more per product.
namespace waymark::kernels {

inline constexpr std::size_t kBlock = 8;       ///< columns: one 64-byte cache line of doubles
inline constexpr std::size_t kAlignment = 64;  ///< bytes

constexpr std::size_t round_down(std::size_t columns) { return columns - columns % kBlock; }
constexpr std::size_t round_up(std::size_t columns) { return round_down(columns + kBlock - 1); }

/// The stride to allocate for rows of `columns` doubles. An odd number of cache lines per row keeps the same
/// column of successive rows out of one cache set.
constexpr std::size_t padded_stride(std::size_t columns) { return (round_up(columns) / kBlock | 1) * kBlock; }

}  // namespace waymark::kernels
