#pragma once

#include <span>
#include <vector>

namespace waymark {

/// How often which NIS was seen, as a density, beside the chi-square density that a consistent filter shows.
struct NisHistogram {
  int dof = 0;  ///< 0: there was nothing to count
  double bin_width = 0.0;
  std::vector<double> density;   ///< of all that were counted, also those beyond the last bin
  std::vector<double> expected;  ///< mean of the chi-square density over each bin
};

/// Counts the observations with the most frequent dof; a gate that cuts the tail off is no reason to leave
/// out what it rejected, so pass those too. `nis` and `dof` are of equal length.
[[nodiscard]] NisHistogram nis_histogram(std::span<const double> nis, std::span<const int> dof);

}  // namespace waymark
