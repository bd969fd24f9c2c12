#pragma once

#include <functional>
#include <thread>
#include <vector>

namespace waymark {

/// Threads that call `work`. Where not all of them can be started, `stop` is called, which must make `work`
/// return; those that run are joined, and std::system_error is thrown, which says in words what could not be
/// done.
[[nodiscard]] std::vector<std::thread> start_threads(int count, const std::function<void()>& work,
                                                     const std::function<void()>& stop);

}  // namespace waymark
