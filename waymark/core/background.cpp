#include "waymark/core/background.hpp"

namespace waymark {

Background::Background(bool own_thread) {
  if (own_thread) thread_.emplace([this] { work(); });
}

Background::~Background() {
  if (!thread_) return;
  {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return call_ == nullptr; });
    stopping_ = true;
  }
  changed_.notify_all();
  thread_->join();
}

void Background::start(Call call, void* context) {
  if (!thread_) return call(context);
  {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return call_ == nullptr; });
    call_ = call;
    context_ = context;
  }
  changed_.notify_all();
}

void Background::wait() {
  if (!thread_) return;
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return call_ == nullptr; });
}

void Background::work() {
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [this] { return stopping_ || call_ != nullptr; });
    if (stopping_) return;
    lock.unlock();
    call_(context_);
    lock.lock();
    call_ = nullptr;
    changed_.notify_all();
  }
}

}  // namespace waymark
