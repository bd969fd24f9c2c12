#pragma once

#include <cstdint>

#include "waymark/core/stamp.hpp"
#include "waymark/kernels/instructions.hpp"

namespace waymark::vision {

enum class BudgetKind : std::uint8_t {
  kWork,  ///< what has been done is counted at fixed costs: a replay gives the same bits
  kClock  ///< CPU time of the thread
};

struct FrameBudgetOptions {
  double per_frame_ms = 33.0;
  BudgetKind kind = BudgetKind::kWork;
};

/// What parts of the work take on a slow core, ns: some four times what they take on a desktop's with the
/// oldest vector instructions.
struct WorkCosts {
  double search_ns = 4000.0;  ///< of a patch: rows of image around its windows, and its sums
  double window_ns = 40.0;    ///< and per window
  double peak_ns = 3000.0;    ///< sub-pixel peak and its covariance
  double warp_ns = 20000.0;   ///< a patch drawn anew
  double pixel_ns = 6.0;      ///< of a cell in which corners are searched for
};
[[nodiscard]] WorkCosts work_costs(kernels::Instructions instructions);

/// Time for a part of a frame. Says before each step whether there is still enough for it.
class FrameBudget {
 public:
  explicit FrameBudget(BudgetKind kind) : kind_(kind) {}

  /// From now on, on the calling thread.
  void start(Duration most);
  /// Is there time for something of this cost (WorkCosts)? A clock learns how long that takes here.
  [[nodiscard]] bool allows(double cost_ns);
  /// It was done, and cost this in the end.
  void spend(double cost_ns);

  [[nodiscard]] Duration left() const;
  /// What was first refused since start() would take; zero: nothing was.
  [[nodiscard]] Duration refused() const;

 private:
  BudgetKind kind_;
  double left_ns_ = 0.0;
  double refused_ns_ = 0.0;
  Duration last_{0};
  double ns_per_cost_ = 1.0;
};

}  // namespace waymark::vision
