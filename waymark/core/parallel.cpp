#include "waymark/core/parallel.hpp"

namespace waymark {

ThreadTeam::ThreadTeam(int threads) {
  for (int i = 1; i < threads; ++i) workers_.emplace_back([this] { work(); });
}

ThreadTeam::~ThreadTeam() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  wake_.notify_all();
  for (auto& worker : workers_) worker.join();
}

void ThreadTeam::start(int blocks, Call call, void* context) {
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
}

void ThreadTeam::take_blocks(std::unique_lock<std::mutex>& lock) {
  while (next_block_ < blocks_) {
    const int block = next_block_++;
    lock.unlock();
    call_(context_, block);
    lock.lock();
    if (--unfinished_ == 0) done_.notify_one();
  }
}

void ThreadTeam::work() {
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
