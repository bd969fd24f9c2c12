#include "waymark/slam/yaw_rate_track.hpp"

namespace waymark {

std::optional<double> YawRateTrack::turn_rad(Stamp from, Stamp to, const Event* next) const {
  if (!last_ || from < last_->first || to > last_->first + max_hold_) return std::nullopt;
  std::optional<Reading> after;
  if (next != nullptr && next->stamp > last_->first)
    if (const auto* rate = std::get_if<YawRate>(&next->content)) after = {next->stamp, rate->w_radps};
  return 0.5 * (rate_at(from, after) + rate_at(to, after)) * to_seconds(to - from);
}

double YawRateTrack::rate_at(Stamp stamp, const std::optional<Reading>& next) const {
  if (!next) return last_->second;
  const double fraction = to_seconds(stamp - last_->first) / to_seconds(next->first - last_->first);
  return last_->second + fraction * (next->second - last_->second);
}

}  // namespace waymark
