#include "waymark/core/clocks.hpp"

#include <chrono>
#include <ctime>

namespace waymark {

Duration thread_cpu_time() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return std::chrono::seconds{t.tv_sec} + Duration{t.tv_nsec};
}

Duration monotonic_time() { return std::chrono::steady_clock::now().time_since_epoch(); }

}  // namespace waymark
