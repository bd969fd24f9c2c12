#pragma once

// The instruction sets that kernels are compiled for: on x86-64 AVX-512, AVX2, SSE4 and plain C++. Processors
// with SSSE3 and no more were last made in 2008, and run the plain code. Structs of vectors need a vector
// size known at compile time, so SVE machines run the NEON code. To be included before anything else of
// Highway.
#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV | HWY_SSSE3)
#include <hwy/targets.h>
