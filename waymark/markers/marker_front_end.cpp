#include "waymark/markers/marker_front_end.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include "waymark/core/text.hpp"
#include "waymark/core/threads.hpp"

namespace waymark {
namespace {

/// Identities whose sightings the filter often refused as too far from where they should be, as when two
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
      lines.push_back(concat(
          "marker ", id.number, " was ", of.refused, " times out of ", of.all,
          " not where it should be: do two markers bear this number, or is markers.size_m not its own?"));
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

void MarkerFinder::announce(Picture picture) {
  if (threads_.empty()) return;
  {
    const std::lock_guard lock(mutex_);
    waiting_.push_back(std::move(picture));
  }
  changed_.notify_all();
}

MarkerFinder::Finds MarkerFinder::take(const Picture& picture) {
  if (threads_.empty()) return look(*picture);
  std::unique_lock lock(mutex_);
  if (!is_done(picture, lock)) std::rethrow_exception(failure_);
  return std::move(done_.extract(picture).mapped());
}

void MarkerFinder::drop(const Picture& picture) {
  if (threads_.empty()) return;
  std::unique_lock lock(mutex_);
  if (is_done(picture, lock)) done_.erase(done_.find(picture));
}

bool MarkerFinder::is_done(const Picture& picture, std::unique_lock<std::mutex>& lock) {
  changed_.wait(lock, [&] { return failure_ != nullptr || done_.contains(picture); });
  return done_.contains(picture);
}

MarkerFinder::Finds MarkerFinder::look(const GreyImage& picture) {
  const Duration start = thread_cpu_time();
  Finds finds{detector_->detect(picture), {}};
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
      sighter_(camera, options, set),
      check_(set.dictionary),
      finder_(std::move(detector), options.own_thread) {}

bool MarkerFrontEnd::fits(const ImageView& image) const {
  return image.width_px == camera_.width_px() && image.height_px == camera_.height_px();
}

FrontEnd::Seen MarkerFrontEnd::see(const Picture& picture) {
  const MarkerFinder::Finds finds = finder_.take(picture);
  blocks_.record(0, finds.cpu);
  BlockTimer timer(blocks_, 1);
  measure(picture, finds.markers);
  refuse_duplicates();
  hold_back_new();
  timer.finish(1);
  return std::span<const Observation>(sightings_);
}

std::span<const Observation> MarkerFrontEnd::see(const MarkerOutlines& outlines) {
  BlockTimer timer(blocks_, 1);
  measure(outlines);
  refuse_duplicates();
  hold_back_new();
  timer.finish(1);
  return sightings_;
}

void MarkerFrontEnd::measure(const Picture& picture, std::span<const markers::Marker> found) {
  sightings_.clear();
  std::vector<std::int32_t> ids;
  for (const markers::Marker& marker : found) {
    const auto seen = sighter_.sight(*picture, marker);
    const auto* refusal = std::get_if<markers::Refusal>(&seen);
    take(seen);
    if (refusal == nullptr || *refusal != markers::Refusal::kNoBorder) ids.push_back(marker.id);
  }
  check_.add(picture, ids);
}

void MarkerFrontEnd::measure(const MarkerOutlines& outlines) {
  sightings_.clear();
  for (const MarkerOutline& outline : outlines) take(sighter_.sight(outline.corners_px, outline.id));
  std::ranges::stable_sort(sightings_, {}, [](const Observation& each) { return *each.id; });
}

void MarkerFrontEnd::take(const std::variant<Observation, markers::Refusal>& seen) {
  if (const auto* refusal = std::get_if<markers::Refusal>(&seen))
    ++refused_[static_cast<std::size_t>(*refusal)];
  else
    sightings_.push_back(std::get<Observation>(seen));
}

/// Nobody knows which of them is the one of the map. They come in the order of their identities.
void MarkerFrontEnd::refuse_duplicates() {
  for (auto first = sightings_.begin(); first != sightings_.end();) {
    const auto last =
        std::find_if(first, sightings_.end(), [&](const auto& each) { return each.id != first->id; });
    if (last - first == 1) {
      first = last;
      continue;
    }
    ++duplicates_[*first->id];
    refused_[static_cast<std::size_t>(markers::Refusal::kDuplicate)] += last - first;
    first = sightings_.erase(first, last);
  }
}

/// What a wall happens to show of a marker does not last.
void MarkerFrontEnd::hold_back_new() {
  constexpr std::int64_t kGapMax = 15;  // pictures
  ++pictures_;
  std::erase_if(sightings_, [this](const Observation& each) {
    Trial& trial = trials_[*each.id];
    if (trial.sightings >= confirm_) return false;
    if (pictures_ - trial.last_picture > kGapMax) trial.sightings = 0;
    trial.last_picture = pictures_;
    return ++trial.sightings < confirm_;
  });
}

std::vector<std::string> MarkerFrontEnd::notes(std::span<const Innovation> innovations) const {
  std::vector<std::string> lines;
  if (auto verdict = check_.verdict()) lines.push_back(*std::move(verdict));
  for (std::size_t i = 0; i < refused_.size(); ++i)
    if (refused_[i] > 0)
      lines.push_back(concat(refused_[i], " sightings of markers not used: ",
                             markers::describe(static_cast<markers::Refusal>(i))));
  for (const auto& [id, trial] : trials_)
    if (trial.sightings < confirm_)
      lines.push_back(concat("marker ", id.number, " was seen too seldom to be believed (markers.confirm)"));
  for (const auto& [id, pictures] : duplicates_)
    lines.push_back(
        concat("marker ", id.number, " is twice in ", pictures, " pictures: print every number once"));
  std::ranges::move(describe_jumps(innovations), std::back_inserter(lines));
  return lines;
}

}  // namespace waymark
