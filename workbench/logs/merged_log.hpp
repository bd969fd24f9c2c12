#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "workbench/logs/source.hpp"
#include "workbench/logs/text_table.hpp"

namespace waymark {

/// Counts what was skipped or odd, by the words of the note about it.
class Tally {
 public:
  void count(std::string_view what);
  /// "what: 7", in the order in which they came up.
  [[nodiscard]] std::vector<std::string> notes() const;

 private:
  std::vector<std::pair<std::string, std::int64_t>> counts_;
};

/// One table of a log as a stream of events. The stamp is in column 0; observations of one stamp become one
/// event.
class EventStream {
 public:
  /// Makes the content of an event from the row that the table is at, or nothing where the row is to be
  /// skipped. An observation is a list of one.
  using ReadRow = std::function<std::optional<EventContent>(TextTable&, Tally&)>;

  /// What to do with a row whose stamp is before that of the row above.
  enum class BackInTime { kRefuse, kSkip };

  EventStream(TextTable table, ReadRow read_row, BackInTime back_in_time);

  /// Fetches the first event; before anything else.
  void start(Tally& tally);

  /// The event that comes next; empty at the end or at an error.
  [[nodiscard]] const std::optional<Event>& front() const { return front_; }
  [[nodiscard]] Event take(Tally& tally);

  [[nodiscard]] const TextTable& table() const { return table_; }

 private:
  [[nodiscard]] std::optional<Event> read_event(Tally& tally);
  [[nodiscard]] bool keep(Stamp stamp, Tally& tally);
  void advance(Tally& tally);

  TextTable table_;
  ReadRow read_row_;
  BackInTime back_in_time_;
  std::optional<Stamp> last_stamp_;
  std::optional<Event> front_;
  std::optional<Event> ahead_;  // one further, to see where the observations of one stamp end
};

/// Several tables as one log in the order of time; at equal stamps in the order of the streams.
class MergedLog final : public Source {
 public:
  MergedLog(LogInfo info, std::vector<EventStream> streams, std::vector<std::string> notes);

  [[nodiscard]] const LogInfo& info() const override { return info_; }
  [[nodiscard]] Result<std::optional<Event>> next() override;
  [[nodiscard]] std::vector<std::string> notes() const override;
  [[nodiscard]] double progress() const override;

 private:
  LogInfo info_;
  std::vector<EventStream> streams_;
  std::vector<std::string> notes_;
  Tally tally_;
};

}  // namespace waymark
