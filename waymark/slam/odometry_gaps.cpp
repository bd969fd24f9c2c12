#include "waymark/slam/odometry_gaps.hpp"

namespace waymark {

void OdometryGaps::see(Stamp stamp) {
  if (!known_) known_ = stamp;
  newest_ = stamp;
}

void OdometryGaps::see_reading(Stamp stamp) {
  see(stamp);
  if (stamp - *known_ > max_hold_) closed_.push_back({*known_, stamp});
  known_ = stamp;
}

std::vector<OdometryGap> OdometryGaps::all() const {
  std::vector<OdometryGap> gaps = closed_;
  if (known_ && newest_ - *known_ > max_hold_) gaps.push_back({*known_, newest_, true});
  return gaps;
}

}  // namespace waymark
