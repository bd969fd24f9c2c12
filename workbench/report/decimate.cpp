#include "workbench/report/decimate.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace waymark {
namespace {

void add_extremes(Column column, std::size_t begin, std::size_t end, std::vector<std::size_t>& chosen) {
  std::size_t low = end;
  std::size_t high = end;
  for (std::size_t i = begin; i < end; ++i) {
    if (!std::isfinite(column[i])) continue;
    if (low == end || column[i] < column[low]) low = i;
    if (high == end || column[i] > column[high]) high = i;
  }
  if (low != end) chosen.insert(chosen.end(), {low, high});
}

}  // namespace

std::vector<std::size_t> rows_with_extremes(std::size_t rows, std::span<const Column> columns,
                                            std::size_t max_rows) {
  std::vector<std::size_t> chosen;
  if (rows <= max_rows) {
    chosen.resize(rows);
    std::iota(chosen.begin(), chosen.end(), std::size_t{0});
    return chosen;
  }
  const std::size_t per_bucket = std::max<std::size_t>(1, 2 * columns.size());
  const std::size_t buckets = std::max<std::size_t>(1, max_rows < 2 ? 0 : (max_rows - 2) / per_bucket);
  chosen.push_back(0);
  for (std::size_t k = 0; k < buckets; ++k) {
    const std::size_t begin = rows * k / buckets;
    const std::size_t end = rows * (k + 1) / buckets;
    if (columns.empty()) chosen.push_back(begin);
    for (const Column column : columns) add_extremes(column, begin, end, chosen);
  }
  chosen.push_back(rows - 1);
  std::sort(chosen.begin(), chosen.end());
  chosen.erase(std::unique(chosen.begin(), chosen.end()), chosen.end());
  return chosen;
}

}  // namespace waymark
