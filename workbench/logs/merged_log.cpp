#include "workbench/logs/merged_log.hpp"

#include <algorithm>
#include <iterator>

#include "workbench/logs/files.hpp"

namespace waymark {
namespace {

/// Moves the observations of `next` into `event` where both are observations of one stamp.
bool join(Event& event, std::optional<Event>& next) {
  if (!next || next->stamp != event.stamp) return false;
  auto* whole = std::get_if<Observations>(&event.content);
  auto* more = std::get_if<Observations>(&next->content);
  if (whole == nullptr || more == nullptr) return false;
  std::ranges::move(*more, std::back_inserter(*whole));
  return true;
}

std::string about_rows(const TextTable& table, const char* what) {
  return "rows of " + base_name(table.lines().name()) + ' ' + what;
}

}  // namespace

void Tally::count(std::string_view what) {
  const auto found = std::ranges::find(counts_, what, &std::pair<std::string, std::int64_t>::first);
  if (found == counts_.end()) {
    counts_.emplace_back(what, 1);
  } else {
    ++found->second;
  }
}

std::vector<std::string> Tally::notes() const {
  std::vector<std::string> lines;
  for (const auto& [what, count] : counts_) lines.push_back(what + ": " + std::to_string(count));
  return lines;
}

EventStream::EventStream(TextTable table, ReadRow read_row, BackInTime back_in_time)
    : table_(std::move(table)), read_row_(std::move(read_row)), back_in_time_(back_in_time) {}

void EventStream::start(Tally& tally) {
  ahead_ = read_event(tally);
  advance(tally);
}

Event EventStream::take(Tally& tally) {
  Event event = *std::move(front_);
  advance(tally);
  return event;
}

void EventStream::advance(Tally& tally) {
  front_ = std::move(ahead_);
  ahead_.reset();
  if (!front_) return;
  do {
    ahead_ = read_event(tally);
  } while (join(*front_, ahead_));
}

std::optional<Event> EventStream::read_event(Tally& tally) {
  while (table_.next()) {
    const Stamp stamp = back_in_time_ == BackInTime::kRefuse ? table_.ordered_stamp(0) : table_.stamp(0);
    if (!keep(stamp, tally)) continue;
    auto content = read_row_(table_, tally);
    if (table_.error()) break;
    if (!content) continue;
    if (stamp == last_stamp_ && !std::holds_alternative<Observations>(*content))
      tally.count(about_rows(table_, "with the same stamp as the row before"));
    last_stamp_ = stamp;
    return Event{stamp, *std::move(content)};
  }
  return std::nullopt;
}

bool EventStream::keep(Stamp stamp, Tally& tally) {
  const bool skipped = back_in_time_ == BackInTime::kSkip && last_stamp_ && stamp < *last_stamp_;
  if (skipped) tally.count(about_rows(table_, "skipped that go back in time"));
  return !skipped;
}

MergedLog::MergedLog(LogInfo info, std::vector<EventStream> streams, std::vector<std::string> notes)
    : info_(std::move(info)), streams_(std::move(streams)), notes_(std::move(notes)) {
  for (auto& stream : streams_) stream.start(tally_);
}

Result<std::optional<Event>> MergedLog::next() {
  EventStream* earliest = nullptr;
  for (auto& stream : streams_) {
    if (!stream.front() && stream.table().error()) return *stream.table().error();
    if (stream.front() && (earliest == nullptr || stream.front()->stamp < earliest->front()->stamp))
      earliest = &stream;
  }
  if (earliest == nullptr) return std::optional<Event>{};
  return std::optional(earliest->take(tally_));
}

std::vector<std::string> MergedLog::notes() const {
  std::vector<std::string> all = notes_;
  std::ranges::move(tally_.notes(), std::back_inserter(all));
  return all;
}

double MergedLog::progress() const {
  std::size_t bytes = 0;
  std::size_t bytes_read = 0;
  for (const auto& stream : streams_) {
    bytes += stream.table().lines().bytes();
    bytes_read += stream.table().lines().bytes_read();
  }
  return bytes == 0 ? 1.0 : static_cast<double>(bytes_read) / static_cast<double>(bytes);
}

}  // namespace waymark
