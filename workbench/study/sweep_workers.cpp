#include "workbench/study/sweep_workers.hpp"

#include <exception>
#include <utility>

#include "waymark/core/failure.hpp"
#include "waymark/core/threads.hpp"

namespace waymark::study {

SweepWorkers::SweepWorkers(Sweep& sweep, int threads) : sweep_(sweep), working_(threads) {
  threads_ = start_threads(
      threads, [this] { work(); }, [this] { sweep_.stop(); });
}

SweepWorkers::~SweepWorkers() {
  for (auto& thread : threads_) thread.join();
}

void SweepWorkers::work() {
  try {
    make_runs();
  } catch (const std::exception& problem) {
    sweep_.fail(failure(problem));
  }
  --working_;
}

void SweepWorkers::make_runs() {
  while (const auto run = sweep_.take()) {
    auto row = make_run(sweep_.plan(), sweep_.point(*run), [this] { return !sweep_.stopped(); });
    if (row) sweep_.finish(*std::move(row));
  }
}

}  // namespace waymark::study
