#pragma once

#include <array>
#include <cstdint>

namespace waymark {

/// Philox4x32-10 (Salmon, Moraes, Dror, Shaw 2011): four random words from a 128-bit counter and a 64-bit
/// key. A pure function: no state, so any thread may compute any part of a stream.
[[nodiscard]] std::array<std::uint32_t, 4> philox4x32(std::array<std::uint32_t, 4> counter,
                                                      std::array<std::uint32_t, 2> key);

/// What a stream is for. Different purposes under one seed are independent.
enum class StreamPurpose : std::uint32_t {
  kMotion = 1,
  kResampling = 2,
  kSimulation = 3,
  kWorld = 4,
  kInitialisation = 5,
  kImages = 6
};

/// One stream of random numbers per (seed, purpose, step, particle). The same four give the same numbers on
/// any number of threads and in any order of evaluation. About 25 ns per normal.
class RandomStream {
 public:
  RandomStream(std::uint64_t seed, StreamPurpose purpose, std::uint64_t step = 0, std::uint32_t particle = 0);

  /// In [0, 1), 53 bits.
  [[nodiscard]] double uniform();
  [[nodiscard]] double uniform(double low, double high) { return low + (high - low) * uniform(); }
  /// Standard normal, by Box and Muller.
  [[nodiscard]] double normal();

 private:
  [[nodiscard]] std::uint64_t next_word();

  std::array<std::uint32_t, 2> key_;
  std::array<std::uint32_t, 4> counter_;
  std::array<std::uint32_t, 4> block_{};
  unsigned used_ = 4;
  double spare_normal_ = 0.0;
  bool has_spare_ = false;
};

}  // namespace waymark
