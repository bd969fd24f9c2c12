#include "workbench/run/recording.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "workbench/run/filter_run.hpp"

namespace waymark {
namespace {

Result<void> check_span(const TimeSpan& span) {
  if (span.from_s < span.to_s) return {};
  return Error{fmt::format("--to {} is not after --from {}", span.to_s, span.from_s)};
}

/// A span that begins after the log's end.
std::optional<Error> find_empty_span(const TimeSpan& span, double length_s) {
  if (span.from_s <= length_s) return std::nullopt;
  return Error{fmt::format("--from {}: the log is {:.1f} s long", span.from_s, length_s)};
}

/// Feeds the source's events within the span to `accept`; the reason if reading broke off.
std::optional<Error> read_all(Source& source, const TimeSpan& span,
                              const std::function<bool(double)>& keep_going,
                              const std::function<Result<void>(Event)>& accept) {
  constexpr int kEventsPerQuestion = 256;
  std::optional<Stamp> start;
  double elapsed_s = 0.0;
  for (std::int64_t count = 0;; ++count) {
    if (keep_going && count % kEventsPerQuestion == 0 && !keep_going(source.progress()))
      return Error{"stopped; the results so far are kept", Error::Kind::kFailed};
    auto event = source.next();
    if (!event) return event.error();
    if (!*event) return find_empty_span(span, elapsed_s);
    if (!start) start = (*event)->stamp;
    elapsed_s = to_seconds((*event)->stamp - *start);
    if (elapsed_s > span.to_s) return std::nullopt;
    if (elapsed_s < span.from_s) continue;
    if (auto accepted = accept(std::move(**event)); !accepted) return accepted.error();
  }
}

/// As the session did that is replayed, if it is one.
Result<void> give(FilterRun& run, const std::optional<Source::Replay>& replay, Event event) {
  if (!replay) return run.push(std::move(event));
  if (replay->until)
    if (auto processed = run.process_until(*replay->until); !processed) return processed;
  return run.hold(std::move(event));
}

}  // namespace

Result<Recording> record(Source& source, const Config& config, const TimeSpan& span,
                         const std::function<bool(double)>& keep_going) {
  if (auto valid = check_span(span); !valid) return valid.error();
  auto run = FilterRun::make(config);
  if (!run) return run.error();
  auto broke_off = read_all(source, span, keep_going,
                            [&](Event event) { return give(**run, source.replay(), std::move(event)); });
  return (*run)->finish(source.info(), source.notes(), std::move(broke_off), span.from_s <= 0.0);
}

MapState save_map(const Recording& recording) {
  MapState map = recording.filter->save();
  if (!recording.trajectory.empty()) map.stamp = recording.trajectory.back().stamp;
  for (const LandmarkPatch& patch : recording.patches)
    if (std::ranges::find(map.ids, patch.id) != map.ids.end()) map.patches.push_back(patch);
  return map;
}

}  // namespace waymark
