#pragma once

#include <condition_variable>
#include <cstdint>
#include <exception>
#include <mutex>
#include <thread>
#include <type_traits>
#include <vector>

namespace waymark {

/// A few threads that wait for the same job over numbered blocks. The work is cut into blocks by the caller,
/// independently of the number of threads, so that results do not depend on it. Starting a job allocates
/// nothing.
class ThreadPool {
 public:
  /// `threads` >= 1, the caller's included. Throws std::system_error where they cannot be started.
  explicit ThreadPool(int threads);
  ~ThreadPool();
  ThreadPool(const ThreadPool&) = delete;
  ThreadPool& operator=(const ThreadPool&) = delete;

  [[nodiscard]] int size() const { return static_cast<int>(workers_.size()) + 1; }

  /// Calls job(block) for every block in [0, blocks), on any thread and in any order; returns when all are
  /// done. What a job throws ends the others after the blocks under way, and is thrown here.
  template <class Job>
  void run(int blocks, Job&& job) {
    if (workers_.empty() || blocks < 2) {
      for (int block = 0; block < blocks; ++block) job(block);
      return;
    }
    using Callable = std::remove_reference_t<Job>;
    start(
        blocks, [](void* context, int block) { (*static_cast<Callable*>(context))(block); },
        const_cast<std::remove_const_t<Callable>*>(&job));
  }

 private:
  using Call = void (*)(void* context, int block);

  void start(int blocks, Call call, void* context);
  void work();
  void take_blocks(std::unique_lock<std::mutex>& lock);
  void give_up(std::exception_ptr failure);
  void stop();

  std::vector<std::thread> workers_;
  std::mutex mutex_;
  std::condition_variable wake_;
  std::condition_variable done_;
  Call call_ = nullptr;
  void* context_ = nullptr;
  int blocks_ = 0;
  int next_block_ = 0;
  int unfinished_ = 0;
  std::uint64_t job_number_ = 0;
  bool stopping_ = false;
  std::exception_ptr failure_;  ///< the first of the job
};

}  // namespace waymark
