#include "waymark/fastslam/resampling.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>

namespace waymark::fastslam {
namespace {

constexpr std::size_t block_of(std::size_t particle) { return particle / ParticleBlocks::kBlockSize; }

}  // namespace

double effective_particles(std::span<const double> weights) {
  return 1.0 / std::transform_reduce(weights.begin(), weights.end(), 0.0, std::plus<>(),
                                     [](double w) { return w * w; });
}

Resampling::Resampling(ParticleBlocks& blocks)
    : blocks_(blocks),
      offspring_(blocks.capacity()),
      vacant_(blocks.capacity()),
      ancestors_(blocks.capacity()),
      before_(block_of(blocks.capacity()) + 1) {}

std::span<const std::int32_t> Resampling::choose_ancestors(std::span<const double> weights, double u) {
  count_offspring(weights, u);
  list_vacant();
  assign_ancestors();
  return {ancestors_.data(), weights.size()};
}

/// offspring_i = O_i - O_(i-1) with O_i = floor(count C_i + u), C_i the prefix sum divided by the whole sum.
/// At the end of a block C is that of the next block's beginning, so it is 1 at the very end; what rounding
/// leaves over there goes to the last particle that weighs anything: none without weight is revived.
void Resampling::count_offspring(std::span<const double> weights, double u) {
  const auto count = static_cast<double>(weights.size());
  blocks_.run([&](std::size_t begin, std::size_t end) {
    before_[block_of(begin) + 1].weight =
        std::accumulate(weights.begin() + static_cast<std::ptrdiff_t>(begin),
                        weights.begin() + static_cast<std::ptrdiff_t>(end), 0.0);
  });
  const std::size_t blocks = block_of(weights.size() - 1) + 1;
  before_[0].weight = 0.0;
  for (std::size_t b = 0; b < blocks; ++b) before_[b + 1].weight += before_[b].weight;
  const double scale = count / before_[blocks].weight;
  const auto taken_at = [&](double prefix, double most) {
    return std::min(std::floor(prefix * scale + u), most);
  };
  blocks_.run([&](std::size_t begin, std::size_t end) {
    const std::size_t b = block_of(begin);
    const double all = b + 1 == blocks ? count : taken_at(before_[b + 1].weight, count);
    double prefix = before_[b].weight;
    double taken = b == 0 ? 0.0 : taken_at(prefix, count);
    std::size_t last = begin;
    for (std::size_t i = begin; i < end; ++i) {
      prefix += weights[i];
      const double next = std::max(taken_at(prefix, all), taken);
      offspring_[i] = weights[i] > 0.0 ? static_cast<std::int32_t>(next - taken) : 0;
      if (!(weights[i] > 0.0)) continue;
      taken = next;
      last = i;
    }
    offspring_[last] += static_cast<std::int32_t>(all - taken);
  });
}

/// Places without offspring of their own particle, in order, and how many lie before each block.
void Resampling::list_vacant() {
  const std::size_t particles = blocks_.particles();
  blocks_.run([&](std::size_t begin, std::size_t end) {
    Before& next = before_[block_of(begin) + 1];
    next.vacant = 0;
    next.further = 0;
    for (std::size_t i = begin; i < end; ++i) {
      next.vacant += offspring_[i] == 0 ? 1 : 0;
      next.further += static_cast<std::size_t>(offspring_[i] - (keeps_place(i) ? 1 : 0));
    }
  });
  const std::size_t blocks = block_of(particles - 1) + 1;
  before_[0].vacant = 0;
  before_[0].further = 0;
  for (std::size_t b = 0; b < blocks; ++b) {
    before_[b + 1].vacant += before_[b].vacant;
    before_[b + 1].further += before_[b].further;
  }
  blocks_.run([&](std::size_t begin, std::size_t end) {
    std::size_t at = before_[block_of(begin)].vacant;
    for (std::size_t i = begin; i < end; ++i)
      if (offspring_[i] == 0) vacant_[at++] = static_cast<std::int32_t>(i);
  });
}

void Resampling::assign_ancestors() {
  blocks_.run([&](std::size_t begin, std::size_t end) {
    std::size_t at = before_[block_of(begin)].further;
    for (std::size_t i = begin; i < end; ++i) {
      const auto ancestor = static_cast<std::int32_t>(i);
      std::int32_t further = offspring_[i];
      if (keeps_place(i)) {
        ancestors_[i] = ancestor;
        --further;
      }
      for (; further > 0; --further) ancestors_[static_cast<std::size_t>(vacant_[at++])] = ancestor;
    }
  });
}

}  // namespace waymark::fastslam
