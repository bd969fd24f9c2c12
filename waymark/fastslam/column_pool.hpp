#pragma once

#include <cstddef>
#include <vector>

#include "waymark/core/aligned_array.hpp"

namespace waymark::fastslam {

/// Columns of floats, one entry per particle, taken and given back: what landmarks are made of. Memory is
/// taken in slabs and kept, so that a map of steady size allocates nothing.
class ColumnPool {
 public:
  /// Columns of at least `particles` entries, whole blocks of kernels::kParticleLanes.
  explicit ColumnPool(std::size_t particles);

  /// Aligned as kernels want it; holds whatever it held before.
  [[nodiscard]] float* take();
  void give_back(float* column) { free_.push_back(column); }
  /// Takes memory for so many columns now.
  void reserve(std::size_t columns);

 private:
  void add_slab();

  std::size_t stride_;
  std::size_t columns_per_slab_;
  std::size_t columns_ = 0;
  std::vector<AlignedArray<float>> slabs_;
  std::vector<float*> free_;
};

}  // namespace waymark::fastslam
