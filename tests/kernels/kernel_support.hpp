#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "waymark/core/aligned_array.hpp"
#include "waymark/core/random.hpp"
#include "waymark/kernels/highway_targets.hpp"
#include "waymark/kernels/layout.hpp"

namespace waymark::test {

/// Rows of doubles as the kernels want them, padding included, filled with random values.
class Panel {
 public:
  Panel(std::size_t rows, std::size_t columns, RandomStream& random)
      : rows_(rows), columns_(columns), ld_(kernels::padded_stride(columns)), values_(rows * ld_) {
    for (std::size_t i = 0; i < rows * ld_; ++i) values_[i] = random.normal();
  }
  Panel(const Panel& other)
      : rows_(other.rows_), columns_(other.columns_), ld_(other.ld_), values_(rows_ * ld_) {
    std::copy_n(other.data(), rows_ * ld_, data());
  }

  double* data() { return values_.data(); }
  [[nodiscard]] const double* data() const { return values_.data(); }
  [[nodiscard]] std::size_t rows() const { return rows_; }
  [[nodiscard]] std::size_t columns() const { return columns_; }
  [[nodiscard]] std::size_t ld() const { return ld_; }
  double& operator()(std::size_t i, std::size_t j) { return values_[i * ld_ + j]; }
  double operator()(std::size_t i, std::size_t j) const { return values_[i * ld_ + j]; }

 private:
  std::size_t rows_, columns_, ld_;
  AlignedArray<double> values_;
};

/// The same symmetric matrix read through its upper triangle.
inline double symmetric(const Panel& P, std::size_t i, std::size_t j) { return i <= j ? P(i, j) : P(j, i); }

enum class Place { kResult, kScratch, kUntouched };

/// What the kernels may do to element (i, j) of a symmetric matrix stored in its upper triangle.
inline Place triangle_place(const Panel& P, std::size_t i, std::size_t j) {
  if (j >= i && j < P.columns()) return Place::kResult;
  return j >= kernels::round_down(i) && j < kernels::round_up(P.columns()) ? Place::kScratch
                                                                           : Place::kUntouched;
}

/// ... and of a panel of whole rows.
inline Place panel_place(const Panel& W, std::size_t, std::size_t j) {
  if (j < W.columns()) return Place::kResult;
  return j < kernels::round_up(W.columns()) ? Place::kScratch : Place::kUntouched;
}

/// Results near `expected`, and what is out of bounds as `before`.
template <class PlaceOf>
testing::AssertionResult panels_near(const Panel& actual, const Panel& expected, const Panel& before,
                                     PlaceOf place_of, double tolerance) {
  for (std::size_t i = 0; i < actual.rows(); ++i) {
    for (std::size_t j = 0; j < actual.ld(); ++j) {
      const Place place = place_of(actual, i, j);
      if (place == Place::kResult && !(std::abs(actual(i, j) - expected(i, j)) <= tolerance))
        return testing::AssertionFailure() << "(" << i << ", " << j << ") is " << actual(i, j) << ", not "
                                           << expected(i, j) << " (" << actual.columns() << " columns)";
      if (place == Place::kUntouched && actual(i, j) != before(i, j))
        return testing::AssertionFailure() << "(" << i << ", " << j << ") was touched";
    }
  }
  return testing::AssertionSuccess();
}

/// The same bits in all results.
template <class PlaceOf>
testing::AssertionResult same_bits(const Panel& actual, const Panel& expected, PlaceOf place_of) {
  return panels_near(actual, expected, actual, place_of, 0.0);
}

/// Runs a test once per instruction set of this machine, restricted to it.
class OnEveryInstructionSet : public testing::TestWithParam<std::int64_t> {
 protected:
  OnEveryInstructionSet() { hwy::SetSupportedTargetsForTest(GetParam()); }
  ~OnEveryInstructionSet() override { hwy::SetSupportedTargetsForTest(0); }

  RandomStream random_{1, StreamPurpose::kWorld};
};

inline std::string instruction_set_name(const testing::TestParamInfo<std::int64_t>& info) {
  return hwy::TargetName(info.param);
}

/// What `compute` gives on every instruction set with fused multiply-add.
inline std::vector<Panel> on_fused_sets(const std::function<Panel()>& compute) {
  std::vector<Panel> results;
  for (const std::int64_t set : hwy::SupportedAndGeneratedTargets()) {
    const std::string name = hwy::TargetName(set);
    if (!name.starts_with("AVX") && !name.starts_with("NEON")) continue;
    hwy::SetSupportedTargetsForTest(set);
    results.push_back(compute());
  }
  hwy::SetSupportedTargetsForTest(0);
  return results;
}

/// Around every tile and block boundary, and one of many tiles.
inline const std::vector<std::size_t>& sizes() {
  static const std::vector<std::size_t> values = [] {
    std::vector<std::size_t> n;
    for (std::size_t i = 3; i <= 70; ++i) n.push_back(i);
    n.push_back(403);
    return n;
  }();
  return values;
}

}  // namespace waymark::test

#define WAYMARK_ON_EVERY_INSTRUCTION_SET(Suite)                                                   \
  INSTANTIATE_TEST_SUITE_P(Target, Suite, testing::ValuesIn(hwy::SupportedAndGeneratedTargets()), \
                           ::waymark::test::instruction_set_name)
