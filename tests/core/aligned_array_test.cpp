#include "waymark/core/aligned_array.hpp"

#include <algorithm>
#include <cstdint>

#include <gtest/gtest.h>

namespace waymark {
namespace {

TEST(AlignedArray, IsZeroAndAlignedWhateverItsSize) {
  for (const std::size_t count :
       {std::size_t{1}, std::size_t{1000}, ZeroedMemory::kHugePageBytes / sizeof(double),
        ZeroedMemory::kHugePageBytes}) {
    AlignedArray<double> array(count);
    ASSERT_EQ(array.size(), count);
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(array.data()) % 64, 0U);
    EXPECT_TRUE(std::all_of(array.data(), array.data() + count, [](double x) { return x == 0.0; }));
    array[count - 1] = 1.0;
    EXPECT_EQ(array[count - 1], 1.0);
  }
}

TEST(AlignedArray, AGenerousCapacityIsZeroToo) {
  const AlignedArray<double> array(std::size_t{1} << 27);  // 1 GiB
  EXPECT_EQ(array[array.size() - 1], 0.0);
}

}  // namespace
}  // namespace waymark
