#include "waymark/kernels/instruction_set.hpp"

#include <algorithm>
#include <cctype>

#include <gmock/gmock.h>

#include "waymark/kernels/highway_targets.hpp"

namespace waymark::kernels {
namespace {

using testing::ElementsAreArray;

std::string in_use() {
  std::string name = instruction_set();
  std::ranges::transform(name, name.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return name;
}

class InstructionSet : public testing::Test {
 protected:
  ~InstructionSet() override { hwy::SetSupportedTargetsForTest(0); }
};

TEST_F(InstructionSet, IsTheBestOfThoseThatThereAre) {
  const auto sets = instruction_sets();
  ASSERT_FALSE(sets.empty());
  EXPECT_EQ(in_use(), sets.front());
}

TEST_F(InstructionSet, EachCanBeChosenAndStays) {
  const auto sets = instruction_sets();
  for (std::size_t i = 0; i < sets.size(); ++i) {
    ASSERT_TRUE(use_instruction_set(sets[i])) << sets[i];
    EXPECT_EQ(in_use(), sets[i]);
    // Asking which there are must not undo the choice.
    EXPECT_THAT(instruction_sets(),
                ElementsAreArray(sets.begin() + static_cast<std::ptrdiff_t>(i), sets.end()));
    EXPECT_EQ(in_use(), sets[i]);
  }
}

TEST_F(InstructionSet, OthersAreRefusedAndChangeNothing) {
  const std::string before = in_use();
  for (const char* name : {"", "avx", "AVX2", "avx2 ", "altivec"})
    EXPECT_FALSE(use_instruction_set(name)) << name;
  EXPECT_EQ(in_use(), before);
}

}  // namespace
}  // namespace waymark::kernels
