#include "waymark/kernels/move_block.hpp"

#include "kernels/kernel_support.hpp"

namespace waymark::kernels {
namespace {

using test::Panel;
using test::symmetric;

// Which row of the old matrix stands at row i afterwards.
std::size_t source(std::size_t i, std::size_t from, std::size_t to, std::size_t size) {
  return i >= to && i < to + size ? i - to + from : i;
}

void check(std::size_t n, std::size_t from, std::size_t to, std::size_t size) {
  RandomStream random(1, StreamPurpose::kWorld);
  const Panel before(n, n, random);
  Panel P = before;
  move_block(P.data(), P.ld(), n, from, to, size);
  const auto moved_away = [&](std::size_t i) { return i >= from && i < from + size; };
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = i; j < n; ++j) {
      if (moved_away(i) || moved_away(j)) continue;
      ASSERT_EQ(P(i, j), symmetric(before, source(i, from, to, size), source(j, from, to, size)))
          << "(" << i << ", " << j << ") of " << n << ", " << from << " to " << to;
    }
  }
}

TEST(MoveBlock, PutsTheLastLandmarkInPlaceOfAnother) {
  for (const std::size_t size : {1U, 2U, 3U, 6U})
    for (std::size_t to = 3; to + 2 * size <= 33; ++to) check(33, 33 - size, to, size);
}

TEST(MoveBlock, WorksWithRowsBehindTheMovedOnes) { check(40, 20, 3, 3); }

TEST(MoveBlock, WorksOnNeighbours) { check(12, 9, 6, 3); }

}  // namespace
}  // namespace waymark::kernels
