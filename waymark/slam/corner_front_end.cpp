#include "waymark/slam/corner_front_end.hpp"

#include <algorithm>

#include "waymark/core/text.hpp"

namespace waymark {

CornerFrontEnd::CornerFrontEnd(PixelSlam& filter, const vision::TrackerOptions& options,
                               const vision::SearchOptions& search, const Camera& camera, int threads)
    : filter_(filter),
      camera_(camera),
      on_the_clock_(options.budget.kind == vision::BudgetKind::kClock),
      tracker_(options, search, camera, threads) {
  constexpr std::size_t kRoom = 256;  // for innovations of one image
  innovations_.reserve(kRoom);
}

bool CornerFrontEnd::fits(const ImageView& image) const {
  return image.width_px == camera_.width_px() && image.height_px == camera_.height_px();
}

const Correction& CornerFrontEnd::see(const ImageView& image) {
  innovations_.clear();
  stopwatch_.start();
  const auto expectations = filter_.expect();
  filter_took_ = stopwatch_.stop();
  // Vincke Algorithm 1
  tracker_.track(image, filter_.pose().T_world_robot, expectations,
                 [this](vision::Round, const vision::SearchOutcome& seen) -> const Correction& {
                   return correct(seen);
                 });
  leave_time();
  return correction_;
}

/// One round.
const Correction& CornerFrontEnd::correct(const vision::SearchOutcome& outcome) {
  stopwatch_.start();
  const Correction& correction = filter_.correct(outcome.found, outcome.missed);
  filter_took_ += stopwatch_.stop();
  innovations_.insert(innovations_.end(), correction.innovations.begin(), correction.innovations.end());
  correction_ = {innovations_, correction.removed};
  return correction;
}

/// Where the clock counts the tracker leaves the filter as much time as it took at most of late.
void CornerFrontEnd::leave_time() {
  constexpr double kForgotten = 0.02;  // per image
  if (!on_the_clock_) return;
  const auto remembered = std::chrono::duration_cast<Duration>((1.0 - kForgotten) * filter_takes_);
  filter_takes_ = std::max(filter_took_, remembered);
  tracker_.leave_time(filter_takes_);
}

std::vector<std::string> CornerFrontEnd::notes(std::span<const Innovation> /*innovations*/) const {
  const vision::TrackerCounts& counts = tracker_.counts();
  std::vector<std::string> lines;
  if (counts.unusable > 0)
    lines.push_back(concat(counts.unusable, " images show nothing: black, white or covered"));
  if (counts.out_of_budget > 0)
    lines.push_back(
        concat(counts.out_of_budget,
               " images in which searches were postponed for lack of time (tracker.frame_budget_ms)"));
  return lines;
}

}  // namespace waymark
