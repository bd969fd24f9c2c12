#include "waymark/kernels/gather.hpp"

#include "waymark/kernels/particle_columns.hpp"

#include "kernels/kernel_support.hpp"

namespace waymark::kernels {
namespace {

class Gather : public test::OnEveryInstructionSet {};

WAYMARK_ON_EVERY_INSTRUCTION_SET(Gather);

TEST_P(Gather, TakesEachEntryFromItsPlace) {
  for (const std::size_t count : {1U, 15U, 16U, 100U}) {
    const std::size_t padded = round_up_particles(count);
    AlignedArray<float> from(padded), to(padded);
    AlignedArray<std::int32_t> numbers(padded), places(padded), chained(padded);
    for (std::size_t i = 0; i < count; ++i) {
      from[i] = static_cast<float>(random_.normal());
      numbers[i] = static_cast<std::int32_t>(3 * i);
      places[i] = static_cast<std::int32_t>(random_.uniform(0.0, static_cast<double>(count)));
    }
    gather(from.data(), places.data(), to.data(), count);
    gather(numbers.data(), places.data(), chained.data(), count);
    for (std::size_t i = 0; i < count; ++i) {
      EXPECT_EQ(to[i], from[static_cast<std::size_t>(places[i])]);
      EXPECT_EQ(chained[i], 3 * places[i]);
    }
  }
}

}  // namespace
}  // namespace waymark::kernels
