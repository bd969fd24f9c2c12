#pragma once

#include <string>
#include <vector>

namespace waymark::live {

/// Makes the process one that the system keeps waiting as little as it can: memory locked and touched, so
/// that no page is fetched in the loop, and the calling thread, and those that it starts from now on,
/// scheduled SCHED_FIFO below the kernel's own threads. What is not permitted (root, or limits for rtprio and
/// memlock, are needed) is told in one line each, with the way to mend it; the rest holds.
[[nodiscard]] std::vector<std::string> enter_realtime();

}  // namespace waymark::live
