#include "waymark/kernels/add_scaled_rows.hpp"

#include "kernels/kernel_support.hpp"

namespace waymark::kernels {
namespace {

using test::Panel;

class AddScaledRows : public test::OnEveryInstructionSet {
 protected:
  void check(std::size_t n, std::size_t D) {
    const Panel W(D, n, random_), y(1, D, random_), before(1, n, random_);
    Panel x = before, expected = before;
    add_scaled_rows(x.data(), W.data(), W.ld(), D, y.data(), n);
    reference::add_scaled_rows(expected.data(), W.data(), W.ld(), D, y.data(), n);
    EXPECT_TRUE(test::panels_near(x, expected, before, test::panel_place, 1e-12)) << "D = " << D;
  }
};

WAYMARK_ON_EVERY_INSTRUCTION_SET(AddScaledRows);

TEST_P(AddScaledRows, IsThePlainFormulaAtEverySize) {
  for (const std::size_t n : test::sizes()) check(n, 6);
}

TEST_P(AddScaledRows, IsThePlainFormulaAtEveryRank) {
  for (std::size_t D = 1; D <= 41; ++D) check(77, D);
}

}  // namespace
}  // namespace waymark::kernels
