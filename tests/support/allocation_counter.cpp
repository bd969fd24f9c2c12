#include "support/allocation_counter.hpp"

#include <atomic>
#include <cstddef>
#include <cstdlib>

namespace {

constinit std::atomic<std::int64_t> allocations_so_far{0};

}  // namespace

#if defined(__GLIBC__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)

// A program's own malloc takes precedence over that of the C library, which stays reachable by these names.
// NOLINTBEGIN(bugprone-reserved-identifier,readability-identifier-naming)
extern "C" {

void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* memory, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);

void* malloc(std::size_t size) {
  allocations_so_far.fetch_add(1, std::memory_order_relaxed);
  return __libc_malloc(size);
}

void* calloc(std::size_t nmemb, std::size_t size) {
  allocations_so_far.fetch_add(1, std::memory_order_relaxed);
  return __libc_calloc(nmemb, size);
}

void* realloc(void* ptr, std::size_t size) {
  allocations_so_far.fetch_add(1, std::memory_order_relaxed);
  return __libc_realloc(ptr, size);
}

void* aligned_alloc(std::size_t alignment, std::size_t size) {
  allocations_so_far.fetch_add(1, std::memory_order_relaxed);
  return __libc_memalign(alignment, size);
}

}  // extern "C"
// NOLINTEND(bugprone-reserved-identifier,readability-identifier-naming)

#endif

namespace waymark::test {

AllocationCount::AllocationCount() : before_(allocations_so_far.load()) {}

std::int64_t AllocationCount::allocations() const { return allocations_so_far.load() - before_; }

}  // namespace waymark::test
