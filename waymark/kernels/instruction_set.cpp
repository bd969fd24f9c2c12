#include "waymark/kernels/instruction_set.hpp"

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <iterator>

#include "waymark/kernels/highway_targets.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "waymark/kernels/instruction_set.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace waymark::kernels::HWY_NAMESPACE {

const char* name() { return hwy::TargetName(HWY_TARGET); }

}  // namespace waymark::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace waymark::kernels {
namespace {

std::string name_of(std::int64_t target) {
  std::string name = hwy::TargetName(target);
  std::ranges::transform(name, name.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return name;
}

}  // namespace

HWY_EXPORT(name);

const char* instruction_set() { return HWY_DYNAMIC_DISPATCH(name)(); }

std::vector<std::string> instruction_sets() {
  std::vector<std::string> names;
  std::ranges::transform(hwy::SupportedAndGeneratedTargets(), std::back_inserter(names), name_of);
  return names;
}

bool use_instruction_set(std::string_view name) {
  const auto targets = hwy::SupportedAndGeneratedTargets();
  const auto target = std::ranges::find(targets, name, name_of);
  if (target == targets.end()) return false;
  // The better ones are the lower bits. Not DisableTargets(): Highway 1.0.3 forgets it when asked which there
  // are.
  hwy::SetSupportedTargetsForTest(hwy::SupportedTargets() & ~(*target - 1));
  return true;
}

}  // namespace waymark::kernels
#endif
