#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <tuple>
#include <vector>

#include "waymark/core/parallel.hpp"

namespace waymark::fastslam {

/// Runs loops over particles in blocks of fixed size on a few threads. Sums are formed per block and added in
/// the order of the blocks: the same bits on any number of threads. Nothing here allocates after
/// construction.
class ParticleBlocks {
 public:
  static constexpr std::size_t kBlockSize = 256;
  static constexpr std::size_t kMaxTerms = 8;

  /// `particles` >= 1, `threads` >= 1 with the caller's included.
  explicit ParticleBlocks(int particles, int threads = 1)
      : particles_(static_cast<std::size_t>(particles)),
        partial_sums_((particles_ + kBlockSize - 1) / kBlockSize),
        team_(threads) {}

  [[nodiscard]] std::size_t particles() const { return particles_; }

  /// Calls job(begin, end) for every block of particles [begin, end).
  template <class Job>
  void run(Job&& job) {
    team_.run(blocks(), [&](int block) { job(begin(block), end(block)); });
  }

  /// The sum over all blocks of job(begin, end) -> std::array<double, Terms>.
  template <class Job>
  auto sum(Job&& job) {
    using Terms = decltype(job(std::size_t{}, std::size_t{}));
    constexpr std::size_t kTerms = std::tuple_size_v<Terms>;
    static_assert(kTerms <= kMaxTerms);
    team_.run(blocks(), [&](int block) {
      const Terms terms = job(begin(block), end(block));
      std::copy(terms.begin(), terms.end(), partial_sums_[static_cast<std::size_t>(block)].terms.begin());
    });
    Terms total{};
    for (const PartialSum& partial : partial_sums_)
      for (std::size_t k = 0; k < kTerms; ++k) total[k] += partial.terms[k];
    return total;
  }

 private:
  // One cache line each, so that threads do not write to the same one.
  struct alignas(64) PartialSum {
    std::array<double, kMaxTerms> terms{};
  };

  [[nodiscard]] int blocks() const { return static_cast<int>(partial_sums_.size()); }
  [[nodiscard]] static std::size_t begin(int block) { return static_cast<std::size_t>(block) * kBlockSize; }
  [[nodiscard]] std::size_t end(int block) const { return std::min(particles_, begin(block) + kBlockSize); }

  std::size_t particles_;
  std::vector<PartialSum> partial_sums_;
  ThreadTeam team_;
};

}  // namespace waymark::fastslam
