#pragma once

#include <array>
#include <utility>

namespace waymark {

/// Rows and columns of the upper triangle of a covariance of three, row by row.
inline constexpr std::array<std::pair<int, int>, 6> kUpperTriangle{
    {{0, 0}, {0, 1}, {0, 2}, {1, 1}, {1, 2}, {2, 2}}};

}  // namespace waymark
