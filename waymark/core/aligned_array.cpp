#include "waymark/core/aligned_array.hpp"

#include <sys/mman.h>

#include <memory>
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
  void* data = block;
  std::size_t room = bytes + alignment;
  std::align(alignment, bytes, data, room);
#ifdef MADV_HUGEPAGE
  // A wish: without huge pages everything is only slower.
  if (huge) madvise(data, bytes, MADV_HUGEPAGE);
#endif
  return {block, data};
}

}  // namespace waymark
