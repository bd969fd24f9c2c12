#include "waymark/markers/marker_front_end.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include "waymark/core/text.hpp"
#include "waymark/core/threads.hpp"

namespace waymark {
namespace {

/// Identities whose observations the filter often refused as too far from where they should be, as when two
/// markers bear one number; one line each.
std::vector<std::string> describe_jumps(std::span<const Innovation> innovations) {
  constexpr std::int64_t kMin = 5;
  constexpr std::int64_t kPartMin = 5;  // one in
  struct Counts {
    std::int64_t all = 0, refused = 0;
  };
  std::map<LandmarkId, Counts> counts;
  for (const Innovation& each : innovations) {
    ++counts[each.landmark].all;
    counts[each.landmark].refused += each.outcome == Outcome::kGated ? 1 : 0;
  }
  std::vector<std::string> lines;
  for (const auto& [id, of] : counts)
    if (of.refused >= kMin && kPartMin * of.refused >= of.all)
      lines.push_back(concat("marker ", id.number, " was ", of.refused, " times of ", of.all,
                             " outside its gate: do two markers have this number, or has this one another "
                             "size than markers.size_m?"));
  return lines;
}

}  // namespace

MarkerFinder::MarkerFinder(std::unique_ptr<markers::MarkerDetector> detector, bool own_thread)
    : detector_(std::move(detector)) {
  threads_ = start_threads(
      own_thread ? 1 : 0, [this] { work(); }, [this] { stop(); });
}

MarkerFinder::~MarkerFinder() {
  stop();
  for (auto& thread : threads_) thread.join();
}

void MarkerFinder::stop() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  changed_.notify_all();
}

void MarkerFinder::announce(SharedImage image) {
  if (threads_.empty()) return;
  {
    const std::lock_guard lock(mutex_);
    waiting_.push_back(std::move(image));
  }
  changed_.notify_all();
}

MarkerFinder::Finds MarkerFinder::take(const SharedImage& image) {
  if (threads_.empty()) return look(*image);
  std::unique_lock lock(mutex_);
  if (!is_done(image, lock)) std::rethrow_exception(failure_);
  return std::move(done_.extract(image).mapped());
}

void MarkerFinder::drop(const SharedImage& image) {
  if (threads_.empty()) return;
  std::unique_lock lock(mutex_);
  if (is_done(image, lock)) done_.erase(done_.find(image));
}

bool MarkerFinder::is_done(const SharedImage& image, std::unique_lock<std::mutex>& lock) {
  changed_.wait(lock, [&] { return failure_ != nullptr || done_.contains(image); });
  return done_.contains(image);
}

MarkerFinder::Finds MarkerFinder::look(const GreyImage& image) {
  const Duration start = thread_cpu_time();
  Finds finds{detector_->detect(image), {}};
  finds.cpu = thread_cpu_time() - start;
  return finds;
}

void MarkerFinder::work() {
  try {
    look_at_waiting();
  } catch (...) {
    const std::lock_guard lock(mutex_);
    failure_ = std::current_exception();
    changed_.notify_all();
  }
}

void MarkerFinder::look_at_waiting() {
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [this] { return stopping_ || !waiting_.empty(); });
    if (stopping_) return;
    at_work_ = std::move(waiting_.front());
    waiting_.pop_front();
    lock.unlock();
    Finds finds = look(*at_work_);
    lock.lock();
    done_.emplace(std::exchange(at_work_, nullptr), std::move(finds));
    changed_.notify_all();
  }
}

Result<std::unique_ptr<MarkerFrontEnd>> MarkerFrontEnd::make(const markers::MarkerOptions& options,
                                                             const Camera& camera) {
  const auto set = markers::marker_set(options);
  if (!set) return set.error();
  auto detector = markers::make_marker_detector(set->dictionary);
  if (!detector) return detector.error();
  return std::unique_ptr<MarkerFrontEnd>(new MarkerFrontEnd(options, *set, camera, *std::move(detector)));
}

MarkerFrontEnd::MarkerFrontEnd(const markers::MarkerOptions& options, const markers::MarkerSet& set,
                               const Camera& camera, std::unique_ptr<markers::MarkerDetector> detector)
    : camera_(camera),
      confirm_(options.confirm),
      observer_(camera, options, set),
      check_(set.dictionary),
      finder_(std::move(detector), options.own_thread) {}

bool MarkerFrontEnd::fits(const ImageView& image) const {
  return image.width_px == camera_.width_px() && image.height_px == camera_.height_px();
}

FrontEnd::Seen MarkerFrontEnd::see(const SharedImage& image) {
  const MarkerFinder::Finds finds = finder_.take(image);
  blocks_.record(0, finds.cpu);
  BlockTimer timer(blocks_, 1);
  measure(image, finds.markers);
  refuse_duplicates();
  hold_back_new();
  timer.finish(1);
  return std::span<const Observation>(observations_);
}

std::span<const Observation> MarkerFrontEnd::see(const MarkerOutlines& outlines) {
  BlockTimer timer(blocks_, 1);
  measure(outlines);
  refuse_duplicates();
  hold_back_new();
  timer.finish(1);
  return observations_;
}

void MarkerFrontEnd::measure(const SharedImage& image, std::span<const markers::Marker> found) {
  observations_.clear();
  std::vector<std::int32_t> ids;
  for (const markers::Marker& marker : found) {
    const auto seen = observer_.observe(*image, marker);
    const auto* refusal = std::get_if<markers::Refusal>(&seen);
    take(seen);
    if (refusal == nullptr || *refusal != markers::Refusal::kNoBorder) ids.push_back(marker.id);
  }
  check_.add(image, ids);
}

void MarkerFrontEnd::measure(const MarkerOutlines& outlines) {
  observations_.clear();
  for (const MarkerOutline& outline : outlines) take(observer_.observe(outline.corners_px, outline.id));
  std::ranges::stable_sort(observations_, {}, [](const Observation& each) { return *each.id; });
}

void MarkerFrontEnd::take(const std::variant<Observation, markers::Refusal>& seen) {
  if (const auto* refusal = std::get_if<markers::Refusal>(&seen))
    ++refused_[static_cast<std::size_t>(*refusal)];
  else
    observations_.push_back(std::get<Observation>(seen));
}

/// Nobody knows which of them is the one of the map. They come in the order of their identities.
void MarkerFrontEnd::refuse_duplicates() {
  for (auto first = observations_.begin(); first != observations_.end();) {
    const auto last =
        std::find_if(first, observations_.end(), [&](const auto& each) { return each.id != first->id; });
    if (last - first == 1) {
      first = last;
      continue;
    }
    ++duplicates_[*first->id];
    refused_[static_cast<std::size_t>(markers::Refusal::kDuplicate)] += last - first;
    first = observations_.erase(first, last);
  }
}

/// A new identity must be found in several images, with gaps of at most kGapMax between them, to reject false
/// positives.
void MarkerFrontEnd::hold_back_new() {
  constexpr std::int64_t kGapMax = 15;  // images
  ++images_;
  std::erase_if(observations_, [this](const Observation& each) {
    Trial& trial = trials_[*each.id];
    if (trial.observations >= confirm_) return false;
    if (images_ - trial.last_image > kGapMax) trial.observations = 0;
    trial.last_image = images_;
    return ++trial.observations < confirm_;
  });
}

std::vector<std::string> MarkerFrontEnd::notes(std::span<const Innovation> innovations) const {
  std::vector<std::string> lines;
  if (auto verdict = check_.verdict()) lines.push_back(*std::move(verdict));
  for (std::size_t i = 0; i < refused_.size(); ++i)
    if (refused_[i] > 0)
      lines.push_back(concat(refused_[i], " observations of markers not used: ",
                             markers::describe(static_cast<markers::Refusal>(i))));
  for (const auto& [id, trial] : trials_)
    if (trial.observations < confirm_)
      lines.push_back(
          concat("marker ", id.number, " was found in too few images to be used (markers.confirm)"));
  for (const auto& [id, images] : duplicates_)
    lines.push_back(
        concat("marker ", id.number, " appears twice in ", images, " images: print each number only once"));
  std::ranges::move(describe_jumps(innovations), std::back_inserter(lines));
  return lines;
}

}  // namespace waymark
