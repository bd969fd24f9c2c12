#pragma once

#include <cstdint>

namespace waymark::test {

/// Counts the blocks of memory taken from the heap (malloc and all that rests on it: new, Eigen, std::vector)
/// by any thread since it was made. Always 0 under a sanitizer, which has a heap of its own, and where there
/// is no glibc.
class AllocationCount {
 public:
  AllocationCount();
  [[nodiscard]] std::int64_t allocations() const;

 private:
  std::int64_t before_;
};

}  // namespace waymark::test
