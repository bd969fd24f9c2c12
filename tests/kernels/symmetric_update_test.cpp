#include "waymark/kernels/symmetric_update.hpp"

#include "kernels/kernel_support.hpp"

namespace waymark::kernels {
namespace {

using test::Panel;
using test::panels_near;
using test::same_bits;
using test::triangle_place;

// Sums of a few dozen products of order one.
constexpr double kUpdateTolerance = 1e-12;

class SymmetricUpdate : public test::OnEveryInstructionSet {
 protected:
  // One size and rank, with and without the shear, against the plain formula.
  void check(std::size_t n, std::size_t D) {
    const Panel W(D, n, random_);
    const Panel shear(2, n, random_);
    const double* d = shear.data();
    const double* e = shear.data() + shear.ld();
    const Panel before(n, n, random_);
    Panel P = before, expected = before;
    symmetric_downdate(P.data(), P.ld(), n, W.data(), W.ld(), D, {0, n});
    reference::symmetric_update(expected.data(), P.ld(), n, W.data(), W.ld(), D, nullptr, nullptr);
    EXPECT_TRUE(panels_near(P, expected, before, triangle_place, kUpdateTolerance)) << "D = " << D;
    Panel sheared = before, expected_sheared = before;
    symmetric_update(sheared.data(), P.ld(), n, W.data(), W.ld(), D, d, e, {0, n});
    reference::symmetric_update(expected_sheared.data(), P.ld(), n, W.data(), W.ld(), D, d, e);
    EXPECT_TRUE(panels_near(sheared, expected_sheared, before, triangle_place, kUpdateTolerance))
        << "shear, D = " << D;
  }
};

WAYMARK_ON_EVERY_INSTRUCTION_SET(SymmetricUpdate);

TEST_P(SymmetricUpdate, IsThePlainFormulaAtEverySize) {
  for (const std::size_t n : test::sizes()) check(n, 5);
}

TEST_P(SymmetricUpdate, IsThePlainFormulaAtEveryRank) {
  for (std::size_t D = 0; D <= 41; ++D) check(61, D);
}

TEST_P(SymmetricUpdate, ASymmetricProductOfTwoPanelsIsTheSameAsOfOne) {
  const std::size_t n = 61;
  for (std::size_t D = 0; D <= 9; ++D) {
    const Panel A(D, n, random_), shear(2, n, random_), before(n, n, random_);
    Panel B = A;  // psi A with psi = 2 I
    for (std::size_t k = 0; k < D; ++k)
      for (std::size_t j = 0; j < n; ++j) B(k, j) *= 2.0;
    const double* d = shear.data();
    const double* e = shear.data() + shear.ld();
    Panel P = before, expected = before;
    symmetric_product_update(P.data(), P.ld(), n, A.data(), B.data(), A.ld(), D, d, e, {0, n});
    reference::symmetric_update(expected.data(), P.ld(), n, A.data(), A.ld(), D, nullptr, nullptr);
    reference::symmetric_update(expected.data(), P.ld(), n, A.data(), A.ld(), D, d, e);
    EXPECT_TRUE(panels_near(P, expected, before, triangle_place, kUpdateTolerance)) << "D = " << D;
  }
}

TEST_P(SymmetricUpdate, SubtractsAProductFromWholeRows) {
  for (const std::size_t rows : {1U, 7U, 24U, 51U}) {
    for (const std::size_t n : test::sizes()) {
      const Panel A(5, rows, random_), B(5, n, random_), before(rows, n, random_);
      Panel P = before, expected = before;
      subtract_product(P.data(), P.ld(), n, A.data(), A.ld(), B.data(), B.ld(), 5, {0, rows});
      for (std::size_t i = 0; i < rows; ++i)
        for (std::size_t j = 0; j < n; ++j)
          for (std::size_t k = 0; k < 5; ++k) expected(i, j) -= A(k, i) * B(k, j);
      EXPECT_TRUE(panels_near(P, expected, before, test::panel_place, kUpdateTolerance))
          << rows << " x " << n;
    }
  }
}

TEST_P(SymmetricUpdate, GivesTheSameBitsInAnyBands) {
  const std::size_t n = 203, D = 7;
  const Panel W(D, n, random_), shear(2, n, random_), before(n, n, random_);
  const auto update = [&](Panel& P, RowBand band) {
    symmetric_update(P.data(), P.ld(), n, W.data(), W.ld(), D, shear.data(), shear.data() + shear.ld(), band);
  };
  Panel whole = before;
  update(whole, {0, n});
  for (const std::size_t count : {2U, 3U, 5U, 64U}) {
    Panel P = before;
    for (std::size_t band = 0; band < count; ++band) update(P, triangle_band(n, band, count));
    EXPECT_TRUE(same_bits(P, whole, triangle_place)) << count << " bands";
  }
  Panel P = before;
  for (const RowBand band : {RowBand{0, 3}, RowBand{3, 50}, RowBand{50, 201}, RowBand{201, n}})
    update(P, band);
  EXPECT_TRUE(same_bits(P, whole, triangle_place)) << "bands cut inside a block";
}

TEST_P(SymmetricUpdate, LeavesOtherRowsAlone) {
  const std::size_t n = 60, D = 4;
  const Panel W(D, n, random_), before(n, n, random_);
  Panel P = before;
  symmetric_downdate(P.data(), P.ld(), n, W.data(), W.ld(), D, {16, 40});
  for (std::size_t i = 0; i < n; ++i) {
    if (i >= 16 && i < 40) continue;
    for (std::size_t j = 0; j < P.ld(); ++j) ASSERT_EQ(P(i, j), before(i, j)) << i << ", " << j;
  }
}

TEST(SymmetricUpdateBits, AreTheSameOnAllFusedInstructionSets) {
  const std::size_t n = 131, D = 9;
  RandomStream random(2, StreamPurpose::kWorld);
  const Panel W(D, n, random), shear(2, n, random), before(n, n, random);
  const std::vector<Panel> results = test::on_fused_sets([&] {
    Panel P = before;
    symmetric_update(P.data(), P.ld(), n, W.data(), W.ld(), D, shear.data(), shear.data() + shear.ld(),
                     {0, n});
    return P;
  });
  for (const Panel& P : results) EXPECT_TRUE(same_bits(P, results.front(), triangle_place));
}

TEST(TriangleBand, CoversEveryRowOnceInSharesOfAboutEqualArea) {
  for (const std::size_t n : {3U, 40U, 403U, 2003U}) {
    for (std::size_t count = 1; count <= 9; ++count) {
      std::size_t next = 0;
      for (std::size_t index = 0; index < count; ++index) {
        const RowBand band = triangle_band(n, index, count);
        EXPECT_EQ(band.begin, next);
        next = band.end;
        const auto rest = [n](std::size_t row) { return 0.5 * static_cast<double>((n - row) * (n - row)); };
        const double share = rest(0) / static_cast<double>(count);
        // A cut is off by less than a block of rows.
        EXPECT_NEAR(rest(band.begin) - rest(band.end), share, static_cast<double>(kBlock * n))
            << n << ", " << count;
      }
      EXPECT_EQ(next, n);
    }
  }
}

}  // namespace
}  // namespace waymark::kernels
