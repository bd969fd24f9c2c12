#include "waymark/kernels/gather.hpp"

#include "waymark/kernels/highway_targets.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "waymark/kernels/gather.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace waymark::kernels::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

template <class Value>
HWY_INLINE void gather_all(const Value* from, const std::int32_t* places, Value* to, std::size_t count) {
  const hn::ScalableTag<Value> values;
  const hn::RebindToSigned<decltype(values)> indices;
  for (std::size_t i = 0; i < count; i += hn::Lanes(values))
    hn::Store(hn::GatherIndex(values, from, hn::Load(indices, places + i)), values, to + i);
}

void gather_floats(const float* from, const std::int32_t* places, float* to, std::size_t count) {
  gather_all(from, places, to, count);
}

void gather_places(const std::int32_t* from, const std::int32_t* places, std::int32_t* to,
                   std::size_t count) {
  gather_all(from, places, to, count);
}

}  // namespace waymark::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace waymark::kernels {

HWY_EXPORT(gather_floats);
HWY_EXPORT(gather_places);

void gather(const float* from, const std::int32_t* places, float* to, std::size_t count) {
  HWY_DYNAMIC_DISPATCH(gather_floats)(from, places, to, count);
}

void gather(const std::int32_t* from, const std::int32_t* places, std::int32_t* to, std::size_t count) {
  HWY_DYNAMIC_DISPATCH(gather_places)(from, places, to, count);
}

}  // namespace waymark::kernels
#endif
