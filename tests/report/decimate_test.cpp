#include "workbench/report/decimate.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

namespace waymark {
namespace {

std::vector<double> wave(std::size_t rows, double frequency) {
  std::vector<double> values(rows);
  for (std::size_t i = 0; i < rows; ++i) values[i] = std::sin(frequency * static_cast<double>(i));
  return values;
}

TEST(RowsWithExtremes, KeepsAllWhenThereAreFew) {
  const auto values = wave(5, 1.0);
  const std::vector<Column> columns{values};
  EXPECT_EQ(rows_with_extremes(5, columns, 5), (std::vector<std::size_t>{0, 1, 2, 3, 4}));
  EXPECT_TRUE(rows_with_extremes(0, {}, 5).empty());
}

TEST(RowsWithExtremes, KeepsEndsAndSinglePeaksOfEveryColumn) {
  auto first = wave(60'000, 0.01);
  auto second = wave(60'000, 0.003);
  first[12'345] = 50.0;
  second[43'210] = -7.0;
  const std::vector<Column> columns{first, second};
  const auto rows = rows_with_extremes(60'000, columns, 4000);
  EXPECT_LE(rows.size(), 4000U);
  EXPECT_GT(rows.size(), 1000U);
  EXPECT_EQ(rows.front(), 0U);
  EXPECT_EQ(rows.back(), 59'999U);
  EXPECT_TRUE(std::is_sorted(rows.begin(), rows.end(), std::less_equal<>()));
  EXPECT_TRUE(std::binary_search(rows.begin(), rows.end(), 12'345U));
  EXPECT_TRUE(std::binary_search(rows.begin(), rows.end(), 43'210U));
}

// What is left out of a plot lies between what is drawn around it.
TEST(RowsWithExtremes, LeavesOutNothingThatWouldStickOut) {
  const auto values = wave(10'000, 0.7);
  const std::vector<Column> columns{values};
  const std::size_t max_rows = 402;  // 200 runs of 50 rows
  const auto rows = rows_with_extremes(values.size(), columns, max_rows);
  for (std::size_t begin = 0; begin < values.size(); begin += 50) {
    double low = std::numeric_limits<double>::infinity();
    double high = -low;
    for (const auto row : rows) {
      if (row < begin || row >= begin + 50) continue;
      low = std::min(low, values[row]);
      high = std::max(high, values[row]);
    }
    const auto [smallest, largest] =
        std::minmax_element(values.begin() + static_cast<std::ptrdiff_t>(begin),
                            values.begin() + static_cast<std::ptrdiff_t>(begin + 50));
    EXPECT_EQ(low, *smallest);
    EXPECT_EQ(high, *largest);
  }
}

TEST(RowsWithExtremes, PassesOverWhatIsNotFinite) {
  std::vector<double> values(1000, std::numeric_limits<double>::quiet_NaN());
  values[500] = 1.0;
  values[700] = std::numeric_limits<double>::infinity();
  const std::vector<Column> columns{values};
  EXPECT_EQ(rows_with_extremes(1000, columns, 100), (std::vector<std::size_t>{0, 500, 999}));
}

TEST(RowsWithExtremes, ThinsEvenlyWithoutColumns) {
  EXPECT_EQ(rows_with_extremes(100, {}, 6), (std::vector<std::size_t>{0, 25, 50, 75, 99}));
}

TEST(RowsWithExtremes, TakesAnyLimit) {
  const auto values = wave(50, 1.0);
  const std::vector<Column> columns{values};
  for (const std::size_t limit : {0U, 1U, 2U, 3U}) {
    const auto rows = rows_with_extremes(50, columns, limit);
    EXPECT_EQ(rows.front(), 0U);
    EXPECT_EQ(rows.back(), 49U);
    EXPECT_LE(rows.size(), 4U);
  }
}

}  // namespace
}  // namespace waymark
