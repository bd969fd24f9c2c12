#include "waymark/ekf/switch_schedule.hpp"

#include <algorithm>

namespace waymark::ekf {
namespace {

/// Over how many updates the work is spread, if there is time.
constexpr double kSpread = 256.0;

}  // namespace

double SwitchSchedule::share(double remaining, int room) const {
  const double room_left = std::max(room, 0) / static_cast<double>(std::max(room_, 1));
  const double due = remaining - work_ * std::min(1.0, 2.0 * room_left);
  return std::max(work_ / kSpread, due);
}

}  // namespace waymark::ekf
