#include "waymark/core/random.hpp"

#include <cmath>

#include "waymark/core/angle.hpp"

namespace waymark {

std::array<std::uint32_t, 4> philox4x32(std::array<std::uint32_t, 4> counter,
                                        std::array<std::uint32_t, 2> key) {
  for (int round = 0; round < 10; ++round) {
    const std::uint64_t p0 = std::uint64_t{0xD2511F53} * counter[0];
    const std::uint64_t p1 = std::uint64_t{0xCD9E8D57} * counter[2];
    counter = {static_cast<std::uint32_t>(p1 >> 32) ^ counter[1] ^ key[0], static_cast<std::uint32_t>(p1),
               static_cast<std::uint32_t>(p0 >> 32) ^ counter[3] ^ key[1], static_cast<std::uint32_t>(p0)};
    key = {key[0] + 0x9E3779B9U, key[1] + 0xBB67AE85U};
  }
  return counter;
}

// The counter holds (block, purpose and the step's high bits, step's low bits, particle); the key is the
// seed.
RandomStream::RandomStream(std::uint64_t seed, StreamPurpose purpose, std::uint64_t step,
                           std::uint32_t particle)
    : key_{static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32)},
      counter_{0, (static_cast<std::uint32_t>(purpose) << 24) ^ static_cast<std::uint32_t>(step >> 32),
               static_cast<std::uint32_t>(step), particle} {}

std::uint64_t RandomStream::next_word() {
  if (used_ >= 4) {
    block_ = philox4x32(counter_, key_);
    ++counter_[0];
    used_ = 0;
  }
  const std::uint64_t word = (std::uint64_t{block_[used_]} << 32) | block_[used_ + 1];
  used_ += 2;
  return word;
}

double RandomStream::uniform() { return static_cast<double>(next_word() >> 11) * 0x1.0p-53; }

double RandomStream::normal() {
  if (has_spare_) {
    has_spare_ = false;
    return spare_normal_;
  }
  const double radius = std::sqrt(-2.0 * std::log1p(-uniform()));
  const double angle_rad = 2.0 * kPi * uniform();
  spare_normal_ = radius * std::sin(angle_rad);
  has_spare_ = true;
  return radius * std::cos(angle_rad);
}

}  // namespace waymark
