#pragma once

#include <cstddef>
#include <cstdint>

namespace waymark::kernels {

/// to[i] = from[places[i]] for i < count: how resampling reaches a column. The entries of `to` up to the next
/// multiple of kParticleLanes may be overwritten by entries of `from`; `places` is padded with valid places.
void gather(const float* from, const std::int32_t* places, float* to, std::size_t count);
void gather(const std::int32_t* from, const std::int32_t* places, std::int32_t* to, std::size_t count);

}  // namespace waymark::kernels
