#include "waymark/study/crew.hpp"

#include <utility>

namespace waymark::study {

Crew::Crew(Sweep& sweep, int threads) : sweep_(sweep), working_(threads) {
  for (int i = 0; i < threads; ++i) threads_.emplace_back([this] { work(); });
}

Crew::~Crew() {
  for (auto& thread : threads_) thread.join();
}

void Crew::work() {
  while (const auto run = sweep_.take()) {
    auto row = make_run(sweep_.plan(), sweep_.point(*run), [this] { return !sweep_.stopped(); });
    if (row) sweep_.finish(*std::move(row));
  }
  --working_;
}

}  // namespace waymark::study
