#pragma once

#include <optional>
#include <vector>

namespace waymark::eval {

/// The middle value (mean of the two middle ones); nothing for no values. O(n).
[[nodiscard]] std::optional<double> median(std::vector<double> values);

/// Standard deviation per axis of planar errors of these lengths, from their median (Rayleigh distribution),
/// so that up to half may be outliers. Few errors that are left over by a fit of a rigid motion look too
/// small: the factor 1 + 5 / (2n - 3) of Rousseeuw & Leroy 1987 for 2n coordinates and 3 parameters makes up
/// for it. 0 below two errors. O(n).
[[nodiscard]] double robust_sigma(std::vector<double> error_lengths);

}  // namespace waymark::eval
