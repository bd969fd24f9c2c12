#pragma once

#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace waymark {

/// One job at a time on a thread of its own, or at once on the caller's where there is none. Whoever waits
/// before touching what the job touches sees the same either way. What a job throws is thrown to whoever
/// waits for it or starts the next one. Starting a job allocates nothing.
class Background {
 public:
  /// Throws std::system_error where the thread cannot be started.
  explicit Background(bool own_thread);
  ~Background();
  Background(const Background&) = delete;
  Background& operator=(const Background&) = delete;

  /// Calls (object->*Method)(), after the job before.
  template <auto Method, class Object>
  void start(Object* object) {
    start([](void* context) { (static_cast<Object*>(context)->*Method)(); }, object);
  }

  /// Returns when no job is left.
  void wait();

 private:
  using Call = void (*)(void* context);

  void start(Call call, void* context);
  void wait(std::unique_lock<std::mutex>& lock);
  void work();
  void stop();

  std::mutex mutex_;
  std::condition_variable changed_;
  Call call_ = nullptr;  ///< null: idle
  void* context_ = nullptr;
  bool stopping_ = false;
  std::exception_ptr failure_;        ///< of the job before
  std::vector<std::thread> threads_;  ///< one or none
};

}  // namespace waymark
