#include "waymark/core/background.hpp"

#include <utility>

#include "waymark/core/threads.hpp"

namespace waymark {

Background::Background(bool own_thread) {
  threads_ = start_threads(
      own_thread ? 1 : 0, [this] { work(); }, [this] { stop(); });
}

Background::~Background() {
  stop();
  for (auto& thread : threads_) thread.join();
}

/// What was started is done all the same.
void Background::stop() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  changed_.notify_all();
}

void Background::start(Call call, void* context) {
  if (threads_.empty()) return call(context);
  {
    std::unique_lock lock(mutex_);
    wait(lock);
    call_ = call;
    context_ = context;
  }
  changed_.notify_all();
}

void Background::wait() {
  if (threads_.empty()) return;
  std::unique_lock lock(mutex_);
  wait(lock);
}

void Background::wait(std::unique_lock<std::mutex>& lock) {
  changed_.wait(lock, [this] { return call_ == nullptr; });
  if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
}

void Background::work() {
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [this] { return stopping_ || call_ != nullptr; });
    if (call_ == nullptr) return;
    lock.unlock();
    std::exception_ptr failure;
    try {
      call_(context_);
    } catch (...) {
      failure = std::current_exception();
    }
    lock.lock();
    failure_ = std::move(failure);
    call_ = nullptr;
    changed_.notify_all();
  }
}

}  // namespace waymark
