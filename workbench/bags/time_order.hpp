#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "waymark/core/stamp.hpp"

namespace waymark::bag {

/// What a message says of when it was made.
struct MessageTime {
  Stamp recorded;
  std::optional<Stamp> header;    ///< empty: it has none, or one that says nothing
  std::uint32_t content = 0;      ///< a hash of its bytes
  bool expects_a_header = false;  ///< its type has one
};

/// The messages of one topic, in the order of the file.
struct TopicTimes {
  std::string name;
  std::vector<MessageTime> messages;
};

/// When the messages of a bag were made, on one clock.
struct TimeOrder {
  /// Of a message that is not used.
  static constexpr Stamp kSkipped{Duration::max()};

  std::vector<std::vector<Stamp>> stamps;  ///< by topic, and by its place in the file
  std::vector<std::string> notes;          ///< what was skipped, moved or doubted, one line each
};

/// The stamp of a message is that of its header; where it has none, the time of recording less the topic's
/// usual delay. What is mended, and told:
///
/// - A clock that was set back (a topic goes back in time, and its pieces do not make one span of time when
///   sorted, as those of a shuffled file do): what lies behind goes on from there.
/// - A header clock that was set while the recording went on, or is another than that of the first topic: of
///   stamps and times of recording those count that bring the two topics together. The stamps are moved by
///   the difference of the medians.
/// - A stamp that stands still while messages go on being recorded: it goes on with these.
/// - Single stamps that jump, and messages that are there twice, are skipped.
///
/// O(n log n) for n messages.
[[nodiscard]] TimeOrder find_time_order(std::vector<TopicTimes> topics, bool by_header);

/// Of each message the earliest stamp of it and all behind it.
[[nodiscard]] std::vector<Stamp> earliest_from(const std::vector<Stamp>& stamps);

/// How far at most a message lies behind others with later stamps. `sequence` holds the topic of each message
/// of the file.
[[nodiscard]] Duration disorder(const TimeOrder& order, std::span<const std::uint32_t> sequence);

}  // namespace waymark::bag
