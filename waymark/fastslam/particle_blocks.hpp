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
  static constexpr std::size_t kMaxTerms = 10;

  /// `capacity` >= 1 particles at most, all of them at first; `threads` >= 1 with the caller's included.
  explicit ParticleBlocks(int capacity, int threads = 1)
      : particles_(static_cast<std::size_t>(capacity)),
        partial_sums_((particles_ + kBlockSize - 1) / kBlockSize),
        thread_pool_(threads) {}

  [[nodiscard]] std::size_t particles() const { return particles_; }
  [[nodiscard]] std::size_t capacity() const { return partial_sums_.size() * kBlockSize; }
  /// Later loops run over so many particles, at most the capacity.
  void resize(std::size_t particles) { particles_ = particles; }

  /// Calls job(begin, end) for every block of particles [begin, end).
  template <class Job>
  void run(Job&& job) {
    const auto run_blocks = [&](int first, int last) {
      for (int block = first; block < last; ++block) job(begin(block), end(block));
    };
    if (blocks() < kBlocksWorthThreads) return run_blocks(0, blocks());
    const int portion = std::max(1, blocks() / (kPortionsPerThread * thread_pool_.size()));
    thread_pool_.run((blocks() + portion - 1) / portion,
                     [&](int k) { run_blocks(k * portion, std::min((k + 1) * portion, blocks())); });
  }

  /// The sum over all blocks of job(begin, end) -> std::array<double, Terms>.
  template <class Job>
  auto sum(Job&& job) {
    using Terms = decltype(job(std::size_t{}, std::size_t{}));
    constexpr std::size_t kTerms = std::tuple_size_v<Terms>;
    static_assert(kTerms <= kMaxTerms);
    run([&](std::size_t begin, std::size_t end) {
      const Terms terms = job(begin, end);
      std::copy(terms.begin(), terms.end(), partial_sums_[begin / kBlockSize].terms.begin());
    });
    Terms total{};
    for (int block = 0; block < blocks(); ++block)
      for (std::size_t k = 0; k < kTerms; ++k)
        total[k] += partial_sums_[static_cast<std::size_t>(block)].terms[k];
    return total;
  }

  /// The largest of job(begin, end) over all blocks.
  template <class Job>
  double largest(Job&& job) {
    run([&](std::size_t begin, std::size_t end) {
      partial_sums_[begin / kBlockSize].terms[0] = job(begin, end);
    });
    double best = partial_sums_[0].terms[0];
    for (int block = 1; block < blocks(); ++block)
      best = std::max(best, partial_sums_[static_cast<std::size_t>(block)].terms[0]);
    return best;
  }

 private:
  // Waking a thread takes as long as some thousand landmark updates.
  static constexpr int kBlocksWorthThreads = 8;
  // Threads take portions of many blocks: taking one means a lock, for which they would queue. Few portions
  // would let one thread wait for another at the end.
  static constexpr int kPortionsPerThread = 16;

  // Whole cache lines, so that threads do not write to the same one.
  struct alignas(64) PartialSum {
    std::array<double, kMaxTerms> terms{};
  };

  [[nodiscard]] int blocks() const { return static_cast<int>((particles_ + kBlockSize - 1) / kBlockSize); }
  [[nodiscard]] static std::size_t begin(int block) { return static_cast<std::size_t>(block) * kBlockSize; }
  [[nodiscard]] std::size_t end(int block) const { return std::min(particles_, begin(block) + kBlockSize); }

  std::size_t particles_;
  std::vector<PartialSum> partial_sums_;
  ThreadPool thread_pool_;
};

}  // namespace waymark::fastslam
