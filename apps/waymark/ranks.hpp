#pragma once

#include <memory>
#include <string>

#include "waymark/core/result.hpp"

#include "workbench/study/sweep.hpp"

namespace waymark::app {

/// The processes that one mpirun started, this one among them; alone without it. The first hands out the runs
/// of a sweep and keeps the results, the others make one run after the other.
class Ranks {
 public:
  /// Refuses to be started by mpirun where it was built without MPI: the processes would not know each other.
  [[nodiscard]] static Result<std::unique_ptr<Ranks>> join();
  /// Leaves; the first waits until the others have nothing under way.
  ~Ranks();
  Ranks(const Ranks&) = delete;
  Ranks& operator=(const Ranks&) = delete;

  [[nodiscard]] bool is_first() const { return rank_ == 0; }
  [[nodiscard]] int count() const { return count_; }

  /// For the first: takes results in and hands out runs, as far as others asked. False: no other will ask
  /// again.
  bool serve(study::Sweep& sweep);
  /// For the others: makes runs until the first has no more.
  void work(const study::SweepPlan& plan);

 private:
  Ranks() = default;
  bool answer(study::Sweep* sweep);
  int ask(const std::string& result);

  int rank_ = 0;
  int count_ = 1;
  int dismissed_ = 0;  ///< how many others were told that there is no more; of another itself: 1
};

}  // namespace waymark::app
