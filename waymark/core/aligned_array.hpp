#pragma once

#include <cstddef>
#include <cstdlib>
#include <memory>
#include <type_traits>

namespace waymark {

/// Zeros, aligned to a cache line, to be given back to std::free as `block`. From kHugePageBytes to
/// kMaxHugePageBytes they are asked for in huge pages: filters walk over many long rows at once, more than
/// there are entries in the table of page addresses. What is larger than that is a generous capacity, of
/// which small pages commit no more than is used.
struct ZeroedMemory {
  static constexpr std::size_t kHugePageBytes = std::size_t{1} << 20;
  static constexpr std::size_t kMaxHugePageBytes = std::size_t{1} << 28;

  void* block = nullptr;
  void* data = nullptr;
};
/// Throws std::bad_alloc.
[[nodiscard]] ZeroedMemory allocate_zeros(std::size_t bytes);

/// A fixed number of zeros, aligned to 64 bytes. Large arrays take memory page by page as they are first
/// written, so that a generous capacity costs nothing until it is used. Throws std::bad_alloc.
template <class T>
class AlignedArray {
  static_assert(std::is_trivially_copyable_v<T>);

 public:
  explicit AlignedArray(std::size_t count) : size_(count) {
    const ZeroedMemory zeros = allocate_zeros(count * sizeof(T));
    memory_.reset(zeros.block);
    data_ = static_cast<T*>(zeros.data);
  }

  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] T* data() { return data_; }
  [[nodiscard]] const T* data() const { return data_; }
  T& operator[](std::size_t i) { return data_[i]; }
  const T& operator[](std::size_t i) const { return data_[i]; }

 private:
  struct Free {
    void operator()(void* memory) const { std::free(memory); }
  };
  std::unique_ptr<void, Free> memory_;
  T* data_ = nullptr;
  std::size_t size_ = 0;
};

}  // namespace waymark
