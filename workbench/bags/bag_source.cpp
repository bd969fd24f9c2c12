#include "workbench/bags/bag_source.hpp"

#include <algorithm>
#include <functional>
#include <iterator>
#include <map>
#include <set>
#include <sstream>
#include <utility>

#include <fmt/format.h>

#include "workbench/bags/open_bag.hpp"
#include "workbench/bags/time_order.hpp"
#include "workbench/bags/topic_plan.hpp"
#include "workbench/logs/files.hpp"
#include "workbench/logs/merged_log.hpp"

namespace waymark {
namespace {

using bag::Message;
using bag::PlannedTopic;
using bag::TimeOrder;

// A second of large images (1920 x 1080 at 30 Hz) is what may be held to put the messages of a file in order.
constexpr Duration kHeld = std::chrono::seconds(1);
constexpr std::size_t kMaxHeld_bytes = 256'000'000;

std::size_t bytes_held(const Event& event) {
  const auto* image = std::get_if<Image>(&event.content);
  if (image == nullptr) return sizeof(Event);
  if (image->encoded) return sizeof(Event) + image->encoded->size();
  return sizeof(Event) + static_cast<std::size_t>(image->pixels->width_px()) *
                             static_cast<std::size_t>(image->pixels->height_px());
}

/// A topic in use, and how far it has been read.
struct Track {
  PlannedTopic planned;
  std::vector<Stamp> stamps;    ///< of its messages
  std::vector<Stamp> earliest;  ///< of these and all behind them
  std::size_t lane = 0;
  std::size_t next = 0;

  /// No message that is still to come is earlier.
  [[nodiscard]] Stamp horizon() const {
    return next < earliest.size() ? earliest[next] : TimeOrder::kSkipped;
  }
};

/// What lies in the file in the order of time is read at one place; else each topic at a place of its own, so
/// that no topic has to be held until another one is reached.
class BagSource final : public Source {
 public:
  BagSource(std::unique_ptr<bag::Reader> bag, bag::TopicPlan plan, bool by_header, const ReopenBag& reopen)
      : info_(std::move(plan.info)), notes_(std::move(plan.notes)) {
    lanes_.push_back(std::move(bag));
    std::vector<std::size_t> places;
    for (auto& [place, planned] : plan.used) {
      places.push_back(place);
      tracks_.emplace(place, Track{std::move(planned), {}, {}});
    }
    std::ranges::stable_sort(places, {},
                             [this](std::size_t place) { return tracks_.at(place).planned.order; });
    put_in_order(places, by_header, reopen);
  }

  [[nodiscard]] const LogInfo& info() const override { return info_; }

  [[nodiscard]] Result<std::optional<Event>> next() override {
    while (Track* const behind = track_behind()) read_on(behind->lane);
    if (waiting_.empty()) return std::optional<Event>{};
    std::optional event(std::move(waiting_.begin()->second));
    waiting_.erase(waiting_.begin());
    held_bytes_ -= bytes_held(*event);
    given_ = event->stamp;
    return event;
  }

  [[nodiscard]] std::vector<std::string> notes() const override {
    std::vector<std::string> all;
    for (const auto& lane : lanes_)
      for (auto& note : lane->notes()) bag::add_note(all, std::move(note));
    for (const auto& more : {notes_, tally_.notes(), reasons_})
      std::ranges::copy(more, std::back_inserter(all));
    for (const auto& [place, track] : tracks_)
      std::ranges::move(track.planned.reader.notes(), std::back_inserter(all));
    return all;
  }

  [[nodiscard]] double progress() const override {
    double sum = 0.0;
    for (const auto& lane : lanes_) sum += lane->progress();
    return sum / static_cast<double>(lanes_.size());
  }

 private:
  /// Looks through the bag for the times of its messages. `places`: of the topics, odometry first.
  void put_in_order(const std::vector<std::size_t>& places, bool by_header, const ReopenBag& reopen) {
    std::vector<bag::TopicTimes> times;
    std::map<std::size_t, std::uint32_t> numbers;
    for (const std::size_t place : places) {
      numbers.emplace(place, static_cast<std::uint32_t>(times.size()));
      times.push_back({lanes_[0]->summary().topics[place].name, {}});
    }
    std::vector<std::uint32_t> sequence;
    while (const auto message = lanes_[0]->next()) {
      sequence.push_back(numbers.at(message->topic));
      times[sequence.back()].messages.push_back(time_of(*message));
    }
    TimeOrder order = bag::find_time_order(std::move(times), by_header);
    const Duration disorder = bag::disorder(order, sequence);
    for (std::size_t k = 0; k < places.size(); ++k) {
      Track& track = tracks_.at(places[k]);
      track.earliest = bag::earliest_from(order.stamps[k]);
      track.stamps = std::move(order.stamps[k]);
    }
    std::ranges::move(order.notes, std::back_inserter(notes_));
    lanes_[0]->rewind(wanted(places));
    if (disorder > kHeld && places.size() > 1) open_lanes(places, reopen);
  }

  bag::MessageTime time_of(const Message& message) {
    bag::TopicReader& reader = tracks_.at(message.topic).planned.reader;
    constexpr std::size_t kFront = 4096;  // enough to tell images apart
    const auto hash =
        static_cast<std::uint32_t>(std::hash<std::string_view>{}(message.bytes.substr(0, kFront)));
    const bool read = reader.decoder.decode(message.bytes).ok();
    return {message.recorded, read ? reader.stamp() : std::nullopt, hash, read && reader.has_header};
  }

  /// Where the bag cannot be opened again, it is read at one place all the same.
  void open_lanes(const std::vector<std::size_t>& places, const ReopenBag& reopen) {
    std::vector<std::unique_ptr<bag::Reader>> lanes;
    for (const std::size_t place : places) {
      auto lane = reopen ? reopen() : Error{};
      if (!lane || (*lane)->summary().topics.size() != lanes_[0]->summary().topics.size()) return;
      (*lane)->rewind(wanted({place}));
      lanes.push_back(*std::move(lane));
    }
    lanes_ = std::move(lanes);
    for (std::size_t k = 0; k < places.size(); ++k) tracks_.at(places[k]).lane = k;
  }

  [[nodiscard]] std::vector<bool> wanted(const std::vector<std::size_t>& places) const {
    std::vector<bool> wanted(lanes_[0]->summary().topics.size(), false);
    for (const std::size_t place : places) wanted[place] = true;
    return wanted;
  }

  /// The topic from which something may come before, or with, the first event that waits; null: none.
  [[nodiscard]] Track* track_behind() {
    if (held_bytes_ > kMaxHeld_bytes) return nullptr;
    Track* behind = nullptr;
    for (auto& [place, track] : tracks_)
      if (track.next < track.stamps.size() && (behind == nullptr || track.horizon() < behind->horizon()))
        behind = &track;
    const bool settled =
        behind == nullptr || (!waiting_.empty() && waiting_.begin()->first.first < behind->horizon());
    return settled ? nullptr : behind;
  }

  void read_on(std::size_t lane) {
    const auto message = lanes_[lane]->next();
    if (!message) return end(lane);
    Track& track = tracks_.at(message->topic);
    if (track.next == track.stamps.size()) return;  // the file has grown meanwhile
    if (const Stamp stamp = track.stamps[track.next++]; stamp != TimeOrder::kSkipped)
      take(*message, stamp, track.planned);
  }

  void end(std::size_t lane) {
    for (auto& [place, track] : tracks_)
      if (track.lane == lane) track.next = track.stamps.size();
  }

  void take(const Message& message, Stamp stamp, PlannedTopic& topic) {
    auto read = topic.reader.decoder.decode(message.bytes);
    if (!read) return skip(message, "that do not match their message definition", read.error().message);
    auto content = topic.reader.content(topic.reader.decoder);
    if (!content) return skip(message, "that cannot be used", content.error().message);
    add({stamp, *std::move(content)}, topic.order);
  }

  void add(Event event, int order) {
    if (given_ && event.stamp < *given_) {
      tally_.count(fmt::format("messages skipped that lie more than {} MB behind messages with later stamps",
                               kMaxHeld_bytes / 1'000'000));
      return;
    }
    held_bytes_ += bytes_held(event);
    const std::pair key(event.stamp, order);
    waiting_.emplace(key, std::move(event));
  }

  /// Counted, and the reason told once per topic.
  void skip(const Message& message, std::string_view what, const std::string& reason) {
    const std::string& name = lanes_[0]->summary().topics[message.topic].name;
    tally_.count(fmt::format("messages of {} skipped {}", name, what));
    if (explained_.insert(message.topic).second) reasons_.push_back(fmt::format("{}: {}", name, reason));
  }

  LogInfo info_;
  std::vector<std::string> notes_;
  std::vector<std::unique_ptr<bag::Reader>> lanes_;
  std::map<std::size_t, Track> tracks_;                  // by place in the bag's summary
  std::multimap<std::pair<Stamp, int>, Event> waiting_;  // by stamp and order
  std::size_t held_bytes_ = 0;
  std::optional<Stamp> given_;
  Tally tally_;
  std::set<std::size_t> explained_;
  std::vector<std::string> reasons_;
};

std::vector<std::filesystem::path> paths_of(const std::filesystem::path& first, const BagOptions& options) {
  std::vector<std::filesystem::path> paths{first};
  std::istringstream more(options.more_bags);
  for (std::string path; std::getline(more, path, ',');) paths.emplace_back(path);
  return paths;
}

}  // namespace

Result<std::unique_ptr<Source>> make_bag_source(std::unique_ptr<bag::Reader> bag, const std::string& name,
                                                const BagOptions& options, const ReopenBag& reopen) {
  if (!bag->summary().first) {
    const auto notes = bag->notes();
    return Error{
        fmt::format("{}: the bag holds no messages{}", name, notes.empty() ? "" : "; " + notes.back())};
  }
  auto plan = bag::plan_topics(*bag, name, options);
  if (!plan) return plan.error();
  return std::unique_ptr<Source>(std::make_unique<BagSource>(
      std::move(bag), *std::move(plan), options.stamps == BagOptions::Stamps::kHeader, reopen));
}

Result<std::unique_ptr<Source>> open_bag_source(const std::filesystem::path& path,
                                                const BagOptions& options) {
  const ReopenBag open = [paths = paths_of(path, options)] { return bag::open_bags(paths); };
  auto bag = open();
  if (!bag) return bag.error();
  return make_bag_source(*std::move(bag), base_name(path), options, open);
}

}  // namespace waymark
