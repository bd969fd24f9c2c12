#include "workbench/live/clock_map.hpp"

#include <algorithm>
#include <cstdint>

namespace waymark::live {
namespace {

constexpr Duration kBucket = std::chrono::seconds(2);
constexpr Duration kStep = std::chrono::seconds(1);

}  // namespace

Stamp ClockMap::map(Duration device, Stamp arrived) {
  const Duration offset = arrived.since_epoch - device;
  if (!last_ || has_stepped(offset, arrived)) {
    steps_ += last_ ? 1 : 0;
    begin(offset, arrived);
  }
  forget(arrived);
  least_[bucket_] = std::min(least_[bucket_].value_or(offset), offset);
  Stamp stamp = shared_ ? Stamp{device} : Stamp{device + least_offset()};
  stamp = std::min(stamp, arrived);
  if (last_) stamp = std::max(stamp, *last_);
  last_ = stamp;
  return stamp;
}

/// A clock that was set forward comes early at once. One that was set back looks like a reader that stalls,
/// whose arrivals catch up again.
bool ClockMap::has_stepped(Duration offset, Stamp arrived) {
  const Duration least = least_offset();
  if (offset <= least + kStep) late_since_.reset();
  if (offset > least + kStep && !late_since_) late_since_ = arrived;
  return offset < least - kStep || (late_since_ && arrived - *late_since_ > kStep);
}

/// Ends buckets that are full, and with them the oldest ones, but for the last that holds anything.
void ClockMap::forget(Stamp arrived) {
  const auto ended = std::min<std::int64_t>((arrived - bucket_start_) / kBucket, kBuckets);
  if (ended <= 0) return;
  const Duration least = least_offset();
  for (std::int64_t i = 0; i < ended; ++i) {
    bucket_ = (bucket_ + 1) % kBuckets;
    least_[bucket_].reset();
  }
  bucket_start_ = bucket_start_ + kBucket * ((arrived - bucket_start_) / kBucket);
  if (ended == kBuckets) least_[bucket_] = least;
}

void ClockMap::begin(Duration offset, Stamp arrived) {
  least_.fill(std::nullopt);
  least_[bucket_] = offset;
  bucket_start_ = arrived;
  late_since_.reset();
  shared_ = std::chrono::abs(offset) < kStep;
}

Duration ClockMap::least_offset() const {
  Duration least = Duration::max();
  for (const auto& each : least_) least = std::min(least, each.value_or(Duration::max()));
  return least;
}

}  // namespace waymark::live
