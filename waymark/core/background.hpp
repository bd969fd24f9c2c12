#pragma once

#include <condition_variable>
#include <mutex>
#include <optional>
#include <thread>

namespace waymark {

/// One job at a time on a thread of its own, or at once on the caller's where there is none. Whoever waits
/// before touching what the job touches sees the same either way. Starting a job allocates nothing.
class Background {
 public:
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
  void work();

  std::mutex mutex_;
  std::condition_variable changed_;
  Call call_ = nullptr;  ///< null: idle
  void* context_ = nullptr;
  bool stopping_ = false;
  std::optional<std::thread> thread_;
};

}  // namespace waymark
