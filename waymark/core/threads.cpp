#include "waymark/core/threads.hpp"

#include <new>
#include <system_error>

#include "waymark/core/text.hpp"

namespace waymark {
namespace {

/// What comes in the way of a further thread, if anything.
std::error_code add_thread(std::vector<std::thread>& threads, const std::function<void()>& work) {
  try {
    threads.emplace_back(work);
    return {};
  } catch (const std::system_error& problem) {
    return problem.code();
  } catch (const std::bad_alloc&) {
    return std::make_error_code(std::errc::not_enough_memory);
  }
}

}  // namespace

std::vector<std::thread> start_threads(int count, const std::function<void()>& work,
                                       const std::function<void()>& stop) {
  std::vector<std::thread> threads;
  while (std::ssize(threads) < count) {
    const std::error_code failed = add_thread(threads, work);
    if (!failed) continue;
    stop();
    for (auto& thread : threads) thread.join();
    throw std::system_error(
        failed, count == 1 ? "could not start a thread" : concat("could not start ", count, " threads"));
  }
  return threads;
}

}  // namespace waymark
