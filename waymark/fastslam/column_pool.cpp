#include "waymark/fastslam/column_pool.hpp"

#include <algorithm>

namespace waymark::fastslam {
namespace {

constexpr std::size_t kFloatsPerCacheLine = 16;
constexpr std::size_t kFloatsPerSlab = 1 << 16;
constexpr std::size_t kMinColumnsPerSlab = 5;  // one landmark

// Whole cache lines, an odd number of them: the same particle's entries in the columns of a landmark must not
// all fall into one cache set.
std::size_t column_stride(std::size_t particles) {
  const std::size_t lines = (particles + kFloatsPerCacheLine - 1) / kFloatsPerCacheLine;
  return (lines | 1) * kFloatsPerCacheLine;
}

}  // namespace

ColumnPool::ColumnPool(std::size_t particles)
    : stride_(column_stride(particles)),
      columns_per_slab_(std::max(kMinColumnsPerSlab, kFloatsPerSlab / stride_)) {}

void ColumnPool::add_slab() {
  float* const first = slabs_.emplace_back(columns_per_slab_ * stride_).data();
  columns_ += columns_per_slab_;
  free_.reserve(columns_);
  for (std::size_t c = columns_per_slab_; c > 0; --c) free_.push_back(first + (c - 1) * stride_);
}

float* ColumnPool::take() {
  if (free_.empty()) add_slab();
  float* const column = free_.back();
  free_.pop_back();
  return column;
}

void ColumnPool::reserve(std::size_t columns) {
  while (free_.size() < columns) add_slab();
}

}  // namespace waymark::fastslam
