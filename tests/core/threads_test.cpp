#include "waymark/core/threads.hpp"

#include <pthread.h>
#include <sys/resource.h>
#include <unistd.h>

#include <atomic>
#include <fstream>
#include <string>
#include <system_error>

#include <gmock/gmock.h>

#include "support/no_more_threads.hpp"

namespace waymark {
namespace {

using testing::StartsWith;

constexpr rlim_t kMega = 1 << 20;

/// Room in the address space for stacks of 256 MB, of which two fit and not three.
class RoomForTwoThreads {
 public:
  RoomForTwoThreads() {
    getrlimit(RLIMIT_AS, &before_);
    rlimit limit = before_;
    limit.rlim_cur = address_space() + 640 * kMega;
    EXPECT_EQ(setrlimit(RLIMIT_AS, &limit), 0);
    set_stack(256 * kMega);
  }
  RoomForTwoThreads(const RoomForTwoThreads&) = delete;
  RoomForTwoThreads& operator=(const RoomForTwoThreads&) = delete;
  ~RoomForTwoThreads() {
    setrlimit(RLIMIT_AS, &before_);
    set_stack(8 * kMega);
  }

 private:
  static rlim_t address_space() {
    rlim_t pages = 0;
    std::ifstream("/proc/self/statm") >> pages;
    return pages * static_cast<rlim_t>(sysconf(_SC_PAGESIZE));
  }
  static void set_stack(std::size_t bytes) {
    pthread_attr_t attributes;
    pthread_attr_init(&attributes);
    pthread_attr_setstacksize(&attributes, bytes);
    EXPECT_EQ(pthread_setattr_default_np(&attributes), 0);
    pthread_attr_destroy(&attributes);
  }

  rlimit before_{};
};

/// What is said where `count` threads cannot be started.
template <class Work, class Stop>
std::string refusal(int count, Work work, Stop stop) {
  try {
    for (auto& thread : start_threads(count, work, stop)) thread.join();
  } catch (const std::system_error& problem) {
    return problem.what();
  }
  return "";
}

TEST(StartThreads, AllDoTheWork) {
  std::atomic<int> calls = 0;
  for (auto& thread : start_threads(
           5, [&] { ++calls; }, [] {}))
    thread.join();
  EXPECT_EQ(calls, 5);
}

TEST(StartThreads, NoneIsNone) {
  const test::NoMoreThreads none;
  EXPECT_TRUE(start_threads(
                  0, [] {}, [] {})
                  .empty());
}

TEST(StartThreads, ThoseThatCannotBeStartedAreToldInASentence) {
  const test::NoMoreThreads none;
  int stops = 0;
  EXPECT_THAT(refusal(
                  3, [] {}, [&] { ++stops; }),
              StartsWith("could not start 3 threads: "));
  EXPECT_THAT(refusal(
                  1, [] {}, [&] { ++stops; }),
              StartsWith("could not start a thread: "));
  EXPECT_EQ(stops, 2);
}

TEST(StartThreads, ThoseThatWereStartedAreStoppedAndJoinedWhenOneFails) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "sanitizers need all of the address space";
#endif
  const RoomForTwoThreads room;
  std::atomic<bool> stopping = false;
  std::atomic<int> ended = 0;
  const auto work = [&] {
    while (!stopping) std::this_thread::yield();
    ++ended;
  };
  EXPECT_THAT(refusal(8, work, [&] { stopping = true; }), StartsWith("could not start 8 threads: "));
  EXPECT_EQ(ended, 2);
}

}  // namespace
}  // namespace waymark
