#include "waymark/kernels/symmetric_rows.hpp"

#include "kernels/kernel_support.hpp"

namespace waymark::kernels {
namespace {

using test::Panel;
using test::panel_place;
using test::panels_near;
using test::symmetric;

constexpr double kTolerance = 1e-12;

// Rows of P to combine: the first three, and `block` successive ones somewhere.
std::vector<std::size_t> touched_rows(std::size_t n, std::size_t block, RandomStream& random) {
  std::vector<std::size_t> rows = {0, 1, 2};
  const auto first = static_cast<std::size_t>(random.uniform(0.0, static_cast<double>(n - block + 1)));
  for (std::size_t r = 0; r < block; ++r) rows.push_back(first + r);
  return rows;
}

class SymmetricRows : public test::OnEveryInstructionSet {
 protected:
  void check_projection(std::size_t n, std::size_t block, std::size_t D) {
    const Panel P(n, n, random_);
    const std::vector<std::size_t> rows = touched_rows(n, block, random_);
    std::vector<double> H(D * rows.size());
    for (double& h : H) h = random_.normal();
    const Panel before(D, n, random_);
    Panel C = before, expected = before;
    project_rows(P.data(), P.ld(), n, rows.data(), rows.size(), H.data(), D, C.data(), C.ld());
    reference::project_rows(P.data(), P.ld(), n, rows.data(), rows.size(), H.data(), D, expected.data(),
                            C.ld());
    EXPECT_TRUE(panels_near(C, expected, before, panel_place, kTolerance)) << D << " x " << rows.size();
  }

  void check_transform(std::size_t n, std::size_t q) {
    const Panel before(n, n, random_);
    std::vector<double> Phi(q * q);
    for (double& phi : Phi) phi = random_.normal();
    Panel P = before, expected = before;
    transform_leading_rows(P.data(), P.ld(), n, Phi.data(), q);
    reference::transform_leading_rows(expected.data(), P.ld(), n, Phi.data(), q);
    const auto place_of = [q](const Panel& panel, std::size_t i, std::size_t j) {
      return i < q && j >= q ? panel_place(panel, i, j) : test::Place::kUntouched;
    };
    EXPECT_TRUE(panels_near(P, expected, before, place_of, kTolerance)) << "q = " << q;
  }
};

WAYMARK_ON_EVERY_INSTRUCTION_SET(SymmetricRows);

TEST_P(SymmetricRows, GatherIsTheWholeRow) {
  for (const std::size_t n : test::sizes()) {
    const Panel P(n, n, random_);
    for (const std::size_t first : {std::size_t{0}, n / 2, n - 3}) {
      Panel out(3, n, random_);
      gather_rows(P.data(), P.ld(), n, first, 3, out.data(), out.ld());
      for (std::size_t r = 0; r < 3; ++r)
        for (std::size_t j = 0; j < n; ++j) ASSERT_EQ(out(r, j), symmetric(P, first + r, j)) << n << " " << j;
    }
  }
}

TEST_P(SymmetricRows, ProjectionIsThePlainFormulaAtEverySize) {
  for (const std::size_t n : test::sizes()) check_projection(n, 2, 2);
}

TEST_P(SymmetricRows, ProjectionIsThePlainFormulaAtEveryShape) {
  for (std::size_t block = 0; block + 3 <= kMaxRows; ++block)
    for (std::size_t D = 1; D <= 6; ++D) check_projection(150, block, D);
}

TEST_P(SymmetricRows, TransformIsThePlainFormulaAtEverySize) {
  for (const std::size_t n : test::sizes()) check_transform(n, 3);
}

TEST_P(SymmetricRows, TransformIsThePlainFormulaAtEveryOrder) {
  for (std::size_t q = 1; q <= kMaxRows; ++q) check_transform(150, q);
}

TEST(SymmetricRowsBits, AreTheSameOnAllFusedInstructionSets) {
  const std::size_t n = 131;
  RandomStream random(2, StreamPurpose::kWorld);
  const Panel P(n, n, random), H(2, 6, random);
  const std::vector<std::size_t> rows = {0, 1, 2, 77, 78};
  const std::vector<Panel> results = test::on_fused_sets([&] {
    Panel C = Panel(2, n, random);
    project_rows(P.data(), P.ld(), n, rows.data(), rows.size(), H.data(), 2, C.data(), C.ld());
    return C;
  });
  for (const Panel& C : results) EXPECT_TRUE(test::same_bits(C, results.front(), panel_place));
}

}  // namespace
}  // namespace waymark::kernels
