#include "workbench/study/crew.hpp"

#include <exception>
#include <utility>

#include "waymark/core/failure.hpp"
#include "waymark/core/threads.hpp"

namespace waymark::study {

Crew::Crew(Sweep& sweep, int threads) : sweep_(sweep), working_(threads) {
  threads_ = start_threads(
      threads, [this] { work(); }, [this] { sweep_.stop(); });
}

Crew::~Crew() {
  for (auto& thread : threads_) thread.join();
}

void Crew::work() {
  try {
    make_runs();
  } catch (const std::exception& problem) {
    sweep_.fail(failure(problem));
  }
  --working_;
}

void Crew::make_runs() {
  while (const auto run = sweep_.take()) {
    auto row = make_run(sweep_.plan(), sweep_.point(*run), [this] { return !sweep_.stopped(); });
    if (row) sweep_.finish(*std::move(row));
  }
}

}  // namespace waymark::study
