#include "workbench/live/realtime.hpp"

#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>

#include <array>
#include <cerrno>
#include <cstring>

#include <fmt/format.h>

namespace waymark::live {
namespace {

/// Threads of the kernel that serve interrupts have 50.
constexpr int kPriority = 40;
constexpr std::size_t kStack = 512 * 1024;

/// Takes the pages of the stack that a step may need.
void touch_stack() {
  std::array<volatile char, kStack> pages;
  for (std::size_t i = 0; i < pages.size(); i += 4096) pages[i] = 0;
}

}  // namespace

std::vector<std::string> enter_realtime() {
  std::vector<std::string> refused;
  if (mlockall(MCL_CURRENT | MCL_FUTURE | MCL_ONFAULT) != 0)
    refused.push_back(
        fmt::format("--realtime: memory is not locked: {}; give the user a memlock limit in "
                    "/etc/security/limits.conf, or run as root",
                    std::strerror(errno)));
  touch_stack();
  const sched_param priority{.sched_priority = kPriority};
  if (const int error = pthread_setschedparam(pthread_self(), SCHED_FIFO, &priority); error != 0)
    refused.push_back(
        fmt::format("--realtime: threads are not scheduled first: {}; give the user an rtprio "
                    "limit of {} in /etc/security/limits.conf, or run as root",
                    std::strerror(error), kPriority));
  return refused;
}

}  // namespace waymark::live
