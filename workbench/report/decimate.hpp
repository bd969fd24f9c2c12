#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace waymark {

using Column = std::span<const double>;

/// Rows to draw of a table with `rows` rows: ascending, at most `max_rows` of them (but the two ends and one
/// extreme pair of each column always), all when there are no more. The rows are cut into equal runs, and
/// each keeps where every column is smallest and largest, so that no peak is lost in a plot. Every column has
/// `rows` values; those that are not finite are no extremes. O(rows * columns).
[[nodiscard]] std::vector<std::size_t> rows_with_extremes(std::size_t rows, std::span<const Column> columns,
                                                          std::size_t max_rows);

}  // namespace waymark
