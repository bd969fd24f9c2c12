#include "workbench/bags/bag_source.hpp"

#include <algorithm>
#include <iterator>
#include <map>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "workbench/bags/open_bag.hpp"
#include "workbench/bags/topic_plan.hpp"
#include "workbench/logs/files.hpp"
#include "workbench/logs/merged_log.hpp"

namespace waymark {
namespace {

using bag::Message;
using bag::PlannedTopic;

constexpr Duration kWindow = std::chrono::seconds(5);
constexpr std::size_t kMaxHeld_bytes = 64'000'000;
constexpr Duration kJump = std::chrono::seconds(10);

std::size_t bytes_held(const Event& event) {
  const auto* image = std::get_if<Image>(&event.content);
  if (image == nullptr) return sizeof(Event);
  if (image->encoded) return sizeof(Event) + image->encoded->size();
  return sizeof(Event) + static_cast<std::size_t>(image->pixels->width_px()) *
                             static_cast<std::size_t>(image->pixels->height_px());
}

/// How far a topic's stamps are from the times of recording. A single stamp far from the rest is wrong; when
/// a second one agrees with it a clock was set.
class JumpWatch {
 public:
  /// False: a jump.
  bool accept(Duration offset) {
    const auto near = [offset](const std::optional<Duration>& other) {
      return other && std::chrono::abs(offset - *other) <= kJump;
    };
    const bool accepted = !usual_ || near(usual_) || near(suspect_);
    (accepted ? usual_ : suspect_) = offset;
    if (accepted) suspect_.reset();
    return accepted;
  }

 private:
  std::optional<Duration> usual_;
  std::optional<Duration> suspect_;
};

class BagSource final : public Source {
 public:
  BagSource(std::unique_ptr<bag::Reader> bag, bag::TopicPlan plan, bool by_header)
      : bag_(std::move(bag)), plan_(std::move(plan)), by_header_(by_header) {}

  [[nodiscard]] const LogInfo& info() const override { return plan_.info; }

  [[nodiscard]] Result<std::optional<Event>> next() override {
    while (!at_end_ && !is_settled()) {
      if (const auto message = bag_->next()) {
        take(*message);
      } else {
        at_end_ = true;
      }
    }
    if (waiting_.empty()) return std::optional<Event>{};
    std::optional event(std::move(waiting_.begin()->second));
    waiting_.erase(waiting_.begin());
    held_bytes_ -= bytes_held(*event);
    given_ = event->stamp;
    return event;
  }

  [[nodiscard]] std::vector<std::string> notes() const override {
    std::vector<std::string> all = bag_->notes();
    for (const auto& more : {plan_.notes, tally_.notes(), reasons_})
      std::ranges::copy(more, std::back_inserter(all));
    for (const auto& [place, topic] : plan_.used)
      std::ranges::move(topic.reader.notes(), std::back_inserter(all));
    return all;
  }

  [[nodiscard]] double progress() const override { return bag_->progress(); }

 private:
  /// Can nothing any more come before the first event that waits?
  [[nodiscard]] bool is_settled() const {
    if (waiting_.empty()) return false;
    return newest_ - waiting_.begin()->first.first > kWindow || held_bytes_ > kMaxHeld_bytes;
  }

  void take(const Message& message) {
    PlannedTopic& topic = plan_.used.at(message.topic);
    auto read = topic.reader.decoder.decode(message.bytes);
    if (!read) return skip(message, "that do not match their message definition", read.error().message);
    const auto stamp = stamp_of(message, topic);
    if (!stamp) return;
    auto content = topic.reader.content(topic.reader.decoder);
    if (!content) return skip(message, "that cannot be used", content.error().message);
    add({*stamp, *std::move(content)}, topic.order);
  }

  std::optional<Stamp> stamp_of(const Message& message, const PlannedTopic& topic) {
    const auto of_header = by_header_ ? topic.reader.stamp() : std::nullopt;
    if (by_header_ && topic.reader.has_header && !of_header && message.recorded != Stamp{})
      tally_.count(fmt::format(
          "messages of {} without a stamp in the header, placed at their time of recording", name(message)));
    if (!of_header) return message.recorded;
    if (jumps_[message.topic].accept(*of_header - message.recorded)) return of_header;
    tally_.count(
        fmt::format("messages of {} skipped whose stamp jumps by more than 10 s relative to the time of "
                    "recording (input.stamps=recorded uses the latter)",
                    name(message)));
    return std::nullopt;
  }

  void add(Event event, int order) {
    if (given_ && event.stamp < *given_) {
      tally_.count("messages skipped that are recorded more than 5 s after messages with later stamps");
      return;
    }
    newest_ = std::max(newest_, event.stamp);
    held_bytes_ += bytes_held(event);
    const std::pair key(event.stamp, order);
    waiting_.emplace(key, std::move(event));
  }

  /// Counted, and the reason told once per topic.
  void skip(const Message& message, std::string_view what, const std::string& reason) {
    tally_.count(fmt::format("messages of {} skipped {}", name(message), what));
    if (explained_.insert(message.topic).second)
      reasons_.push_back(fmt::format("{}: {}", name(message), reason));
  }

  [[nodiscard]] const std::string& name(const Message& message) const {
    return bag_->summary().topics[message.topic].name;
  }

  std::unique_ptr<bag::Reader> bag_;
  bag::TopicPlan plan_;
  bool by_header_;
  bool at_end_ = false;
  std::multimap<std::pair<Stamp, int>, Event> waiting_;  // by stamp and order
  std::size_t held_bytes_ = 0;
  Stamp newest_{Duration::min()};
  std::optional<Stamp> given_;
  std::map<std::size_t, JumpWatch> jumps_;  // by topic
  Tally tally_;
  std::set<std::size_t> explained_;
  std::vector<std::string> reasons_;
};

}  // namespace

Result<std::unique_ptr<Source>> make_bag_source(std::unique_ptr<bag::Reader> bag, const std::string& name,
                                                const BagOptions& options) {
  if (!bag->summary().first) {
    const auto notes = bag->notes();
    return Error{
        fmt::format("{}: the bag holds no messages{}", name, notes.empty() ? "" : "; " + notes.back())};
  }
  auto plan = bag::plan_topics(*bag, name, options);
  if (!plan) return plan.error();
  return std::unique_ptr<Source>(std::make_unique<BagSource>(std::move(bag), *std::move(plan),
                                                             options.stamps == BagOptions::Stamps::kHeader));
}

Result<std::unique_ptr<Source>> open_bag_source(const std::filesystem::path& path,
                                                const BagOptions& options) {
  auto bag = bag::open_bag(path);
  if (!bag) return bag.error();
  return make_bag_source(*std::move(bag), base_name(path), options);
}

}  // namespace waymark
