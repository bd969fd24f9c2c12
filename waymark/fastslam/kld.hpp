#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "waymark/fastslam/particles.hpp"

namespace waymark::fastslam {

/// So many particles keep the Kullback-Leibler distance between a set that occupies `bins` bins and the
/// belief below `error` with 99 % (Fox 2003): with z the quantile, (k - 1) / (2 error) (1 - 2 / (9 (k - 1)) +
/// sqrt(2 / (9 (k - 1))) z)^3. 1 for a single bin.
[[nodiscard]] double kld_particles(std::size_t bins, double error);

/// Counts the bins of 0.2 m and 5 degrees that particles stand in.
class OccupiedBins {
 public:
  /// For at most so many particles.
  explicit OccupiedBins(std::size_t capacity);

  /// Particles of no weight do not count. O(N), allocates nothing.
  [[nodiscard]] std::size_t count(const Particles& particles);

 private:
  std::vector<std::uint64_t> table_;  // open addressing; 0: free
};

}  // namespace waymark::fastslam
