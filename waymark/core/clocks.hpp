#pragma once

#include "waymark/core/stamp.hpp"

namespace waymark {

/// CPU time of the calling thread. A system call: 0.5 to 2 us, the more the busier a virtual machine's host.
[[nodiscard]] Duration thread_cpu_time();

/// Time since anywhere, never going back; about 0.03 us, no system call.
[[nodiscard]] Duration monotonic_time();

}  // namespace waymark
