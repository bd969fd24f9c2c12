#include "waymark/kernels/multiply_add.hpp"

#include "waymark/kernels/highway_targets.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "waymark/kernels/multiply_add.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace waymark::kernels::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Enough independent chains to hide the latency of a multiply-add on two ports, few enough for 16 registers.
constexpr std::size_t kChains = 12;

MultiplyAdds run(std::size_t rounds) {
  const hn::ScalableTag<double> tag;
  hn::Vec<decltype(tag)> chains[kChains];
  for (std::size_t c = 0; c < kChains; ++c) chains[c] = hn::Set(tag, static_cast<double>(c));
  const auto factor = hn::Set(tag, 0.5);
  for (std::size_t round = 0; round < rounds; ++round)
    for (auto& chain : chains) chain = hn::MulAdd(chain, factor, factor);
  auto sum = hn::Zero(tag);
  for (const auto& chain : chains) sum = hn::Add(sum, chain);
  return {2.0 * static_cast<double>(rounds * kChains * hn::Lanes(tag)),
          hn::GetLane(hn::SumOfLanes(tag, sum))};
}

}  // namespace waymark::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace waymark::kernels {

HWY_EXPORT(run);

MultiplyAdds multiply_add(std::size_t rounds) { return HWY_DYNAMIC_DISPATCH(run)(rounds); }

}  // namespace waymark::kernels
#endif
