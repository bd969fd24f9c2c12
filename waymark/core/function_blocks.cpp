#include "waymark/core/function_blocks.hpp"

#include <ctime>

namespace waymark {

Duration thread_cpu_time() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return std::chrono::seconds{t.tv_sec} + Duration{t.tv_nsec};
}

}  // namespace waymark
