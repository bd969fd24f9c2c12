#include "waymark/core/aligned_array.hpp"

#include <sys/mman.h>

#include <cstdint>
#include <new>

namespace waymark {
namespace {

constexpr std::size_t kCacheLine = 64;
constexpr std::size_t kHugePage = std::size_t{1} << 21;

}  // namespace

ZeroedMemory allocate_zeros(std::size_t bytes) {
  const bool huge = bytes >= ZeroedMemory::kHugePageBytes && bytes <= ZeroedMemory::kMaxHugePageBytes;
  const std::size_t alignment = huge ? kHugePage : kCacheLine;
  void* const block = std::calloc(bytes + alignment, 1);
  if (block == nullptr) throw std::bad_alloc();
  const auto address = reinterpret_cast<std::uintptr_t>(block);
  void* const data = reinterpret_cast<void*>((address + alignment - 1) / alignment * alignment);
#ifdef MADV_HUGEPAGE
  // A wish: without huge pages everything is only slower.
  if (huge) madvise(data, bytes, MADV_HUGEPAGE);
#endif
  return {block, data};
}

}  // namespace waymark
