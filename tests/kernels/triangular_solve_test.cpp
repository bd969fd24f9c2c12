#include "waymark/kernels/triangular_solve.hpp"

#include "kernels/kernel_support.hpp"

namespace waymark::kernels {
namespace {

using test::Panel;
using test::panel_place;
using test::panels_near;

// A triangle whose inverse is of order one, so that errors do not grow.
Panel well_conditioned(std::size_t D, RandomStream& random) {
  Panel L(D, D, random);
  for (std::size_t i = 0; i < D; ++i) {
    for (std::size_t j = 0; j < D; ++j) L(i, j) /= static_cast<double>(D);
    L(i, i) = random.uniform(1.0, 2.0);
  }
  return L;
}

class TriangularSolve : public test::OnEveryInstructionSet {
 protected:
  void check(std::size_t n, std::size_t D) {
    const Panel L = well_conditioned(D, random_);
    const Panel before(D, n, random_);
    Panel W = before, expected = before;
    triangular_solve(L.data(), L.ld(), D, W.data(), W.ld(), n);
    reference::triangular_solve(L.data(), L.ld(), D, expected.data(), W.ld(), n);
    EXPECT_TRUE(panels_near(W, expected, before, panel_place, 1e-12)) << "D = " << D;
  }
};

WAYMARK_ON_EVERY_INSTRUCTION_SET(TriangularSolve);

TEST_P(TriangularSolve, IsThePlainFormulaAtEverySize) {
  for (const std::size_t n : test::sizes()) check(n, 6);
}

TEST_P(TriangularSolve, IsThePlainFormulaAtEveryOrder) {
  for (std::size_t D = 1; D <= 41; ++D) check(77, D);
}

TEST_P(TriangularSolve, TimesTheTriangleGivesTheRightSideBack) {
  const std::size_t n = 50, D = 10;
  const Panel L = well_conditioned(D, random_);
  const Panel C(D, n, random_);
  Panel W = C;
  triangular_solve(L.data(), L.ld(), D, W.data(), W.ld(), n);
  for (std::size_t i = 0; i < D; ++i) {
    for (std::size_t j = 0; j < n; ++j) {
      double product = 0.0;
      for (std::size_t k = 0; k <= i; ++k) product += L(i, k) * W(k, j);
      EXPECT_NEAR(product, C(i, j), 1e-12);
    }
  }
}

TEST(TriangularSolveBits, AreTheSameOnAllFusedInstructionSets) {
  const std::size_t n = 131, D = 11;
  RandomStream random(2, StreamPurpose::kWorld);
  const Panel L = well_conditioned(D, random), before(D, n, random);
  const std::vector<Panel> results = test::on_fused_sets([&] {
    Panel W = before;
    triangular_solve(L.data(), L.ld(), D, W.data(), W.ld(), n);
    return W;
  });
  for (const Panel& W : results) EXPECT_TRUE(test::same_bits(W, results.front(), panel_place));
}

}  // namespace
}  // namespace waymark::kernels
