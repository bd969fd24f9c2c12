#pragma once

#include <cstdint>

namespace waymark::kernels {

/// The code of a kernel: the best vector instructions of this processor, or plain C++ as in a textbook, to be
/// compared with. Results have the same bits.
enum class Instructions : std::uint8_t { kSimd, kScalar };

}  // namespace waymark::kernels
