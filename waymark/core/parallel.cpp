#include "waymark/core/parallel.hpp"

#include <utility>

#include "waymark/core/threads.hpp"

namespace waymark {

ThreadPool::ThreadPool(int threads) {
  workers_ = start_threads(
      threads - 1, [this] { work(); }, [this] { stop(); });
}

ThreadPool::~ThreadPool() {
  stop();
  for (auto& worker : workers_) worker.join();
}

void ThreadPool::stop() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  wake_.notify_all();
}

void ThreadPool::start(int blocks, Call call, void* context) {
  std::unique_lock lock(mutex_);
  call_ = call;
  context_ = context;
  blocks_ = blocks;
  next_block_ = 0;
  unfinished_ = blocks;
  ++job_number_;
  wake_.notify_all();
  take_blocks(lock);
  done_.wait(lock, [this] { return unfinished_ == 0; });
  if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
}

void ThreadPool::take_blocks(std::unique_lock<std::mutex>& lock) {
  while (next_block_ < blocks_) {
    const int block = next_block_++;
    lock.unlock();
    try {
      call_(context_, block);
    } catch (...) {
      give_up(std::current_exception());
    }
    lock.lock();
    if (--unfinished_ == 0) done_.notify_one();
  }
}

void ThreadPool::give_up(std::exception_ptr failure) {
  const std::lock_guard lock(mutex_);
  if (!failure_) failure_ = std::move(failure);
  unfinished_ -= blocks_ - next_block_;  // nobody takes them any more
  next_block_ = blocks_;
}

void ThreadPool::work() {
  std::unique_lock lock(mutex_);
  std::uint64_t seen = 0;
  while (true) {
    wake_.wait(lock, [&] { return stopping_ || job_number_ != seen; });
    if (stopping_) return;
    seen = job_number_;
    take_blocks(lock);
  }
}

}  // namespace waymark
