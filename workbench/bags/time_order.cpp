#include "workbench/bags/time_order.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "workbench/bags/reader.hpp"

namespace waymark::bag {
namespace {

using Messages = std::vector<MessageTime>;

constexpr Duration kBack = std::chrono::seconds(1);   // by which threads of a recorder get out of step
constexpr Duration kJump = std::chrono::seconds(10);  // above the delay of any pipeline that keeps up
// Above the time that a burst of messages of one image takes, below the second of a stamp without fractions.
constexpr Duration kStandsStill = std::chrono::milliseconds(500);
constexpr std::size_t kFewest = 3;  // that make a stamp stand still

// Up to 2038, where the seconds of ROS 2 end: the sums and differences of a few of these fit into a stamp.
constexpr Duration kLatest = std::chrono::seconds(std::numeric_limits<std::int32_t>::max());
constexpr Duration kMostBack = kLatest / 2;
constexpr std::size_t kMostSettings = 100;  // of a clock; what goes back more often is in no order at all

template <class Value>
Value median(std::vector<Value> values) {
  const auto middle = values.begin() + std::ssize(values) / 2;
  std::ranges::nth_element(values, middle);
  return *middle;
}

/// Messages of a topic that lie together in the file.
struct Piece {
  std::size_t begin = 0;
  std::size_t end = 0;

  [[nodiscard]] std::size_t size() const { return end - begin; }
};

/// Cuts where `apart` holds for a message and the next.
template <class Apart>
std::vector<Piece> cut(const Messages& messages, const Apart& apart) {
  std::vector<Piece> pieces;
  for (std::size_t i = 0; i < messages.size(); ++i) {
    if (pieces.empty() || apart(messages[i - 1], messages[i])) pieces.push_back({i, i});
    ++pieces.back().end;
  }
  return pieces;
}

std::span<const MessageTime> part(const Messages& messages, const Piece& piece) {
  return std::span(messages).subspan(piece.begin, piece.size());
}

/// Which of the messages have the header and the bytes of one before them.
std::vector<bool> find_repeated(const Messages& messages) {
  std::vector<bool> repeated(messages.size(), false);
  const auto does_not_go_on = [](const MessageTime& a, const MessageTime& b) {
    return b.header && (!a.header || *a.header >= *b.header);
  };
  if (std::ranges::adjacent_find(messages, does_not_go_on) == messages.end()) return repeated;
  std::vector<std::size_t> places;
  for (std::size_t i = 0; i < messages.size(); ++i)
    if (messages[i].header) places.push_back(i);
  const auto what = [&messages](std::size_t i) {
    return std::pair(*messages[i].header, messages[i].content);
  };
  std::ranges::stable_sort(places, {}, what);
  for (std::size_t k = 1; k < places.size(); ++k)
    repeated[places[k]] = what(places[k - 1]) == what(places[k]);
  return repeated;
}

/// Lets stamps that stand still go on with the times of recording, and says of how many messages.
std::size_t thaw(Messages& messages) {
  std::size_t thawed = 0;
  const auto differ = [](const MessageTime& a, const MessageTime& b) {
    return !a.header || !b.header || *a.header != *b.header;
  };
  for (const Piece& piece : cut(messages, differ)) {
    const Stamp start = messages[piece.begin].recorded;
    if (piece.size() < kFewest || messages[piece.end - 1].recorded - start < kStandsStill) continue;
    for (std::size_t i = piece.begin + 1; i < piece.end; ++i)
      *messages[i].header = *messages[piece.begin].header + (messages[i].recorded - start);
    thawed += piece.size() - 1;
  }
  return thawed;
}

/// By how much the clock of the recording went back before a message, and the rest with it.
struct SetBack {
  std::size_t at = 0;
  Duration by{0};
};

/// Pieces of one span of time in some order: sorted, they neither overlap nor leave a hole, other than one
/// that was recorded.
bool is_shuffled(const Messages& messages, std::vector<Piece> pieces) {
  const auto first = [&](const Piece& piece) { return messages[piece.begin].recorded; };
  const auto last = [&](const Piece& piece) { return messages[piece.end - 1].recorded; };
  std::ranges::sort(pieces, {}, first);
  const auto apart = [&](const Piece& a, const Piece& b) {
    const Duration hole = first(b) - last(a);
    return hole < -kBack || (hole > kJump && a.end != b.begin);
  };
  return std::ranges::adjacent_find(pieces, apart) == pieces.end();
}

Duration usual_step(const Messages& messages) {
  std::vector<Duration> steps;
  for (std::size_t i = 1; i < messages.size(); ++i)
    if (messages[i].recorded > messages[i - 1].recorded)
      steps.push_back(messages[i].recorded - messages[i - 1].recorded);
  return steps.empty() ? Duration{0} : median(std::move(steps));
}

std::vector<SetBack> find_set_back(const Messages& messages) {
  const auto apart = [](const MessageTime& a, const MessageTime& b) {
    return b.recorded < a.recorded - kBack || b.recorded > a.recorded + kJump;
  };
  auto pieces = cut(messages, apart);
  std::erase_if(pieces, [](const Piece& piece) { return piece.size() == 1; });
  std::vector<SetBack> found;
  if (is_shuffled(messages, pieces)) return found;
  const Duration usual = usual_step(messages);
  Duration whole{0};
  for (std::size_t k = 1; k < pieces.size(); ++k) {
    const Duration step = messages[pieces[k].begin].recorded - messages[pieces[k - 1].end - 1].recorded;
    if (step >= -kBack) continue;
    found.push_back({pieces[k].begin, usual - step});
    whole += found.back().by;
    if (found.size() > kMostSettings || whole > kMostBack) return {};
  }
  return found;
}

/// Moves what was recorded behind the step; the headers too where their clock went back with it.
void undo(const SetBack& step, Messages& messages) {
  const auto offset = [](const MessageTime& message) { return *message.header - message.recorded; };
  const MessageTime& before = messages[step.at - 1];
  const bool same_clock = before.header && messages.back().header &&
                          std::chrono::abs(offset(messages.back()) - offset(before)) < step.by / 2;
  for (std::size_t i = step.at; i < messages.size(); ++i) {
    messages[i].recorded = messages[i].recorded + step.by;
    if (messages[i].header && same_clock) messages[i].header = *messages[i].header + step.by;
  }
}

/// Messages whose headers are of one clock.
struct Segment {
  Piece piece;
  Duration offset{0};  ///< of the stamps from the times of recording, the median
};

/// Cuts where a header jumps and the time of recording does not. Messages without header go with those
/// before.
std::vector<Segment> find_segments(const Messages& messages) {
  std::vector<Segment> segments;
  std::optional<std::size_t> last;
  std::vector<Duration> offsets;
  const auto close = [&](std::size_t end) {
    if (segments.empty()) return;
    segments.back().piece.end = end;
    if (!offsets.empty()) segments.back().offset = median(std::exchange(offsets, {}));
  };
  for (std::size_t i = 0; i < messages.size(); ++i) {
    const auto& [recorded, header, content, expected] = messages[i];
    const bool jumps = header && last &&
                       std::chrono::abs((*header - *messages[*last].header) -
                                        (recorded - messages[*last].recorded)) > kJump &&
                       std::chrono::abs(*header - *messages[*last].header) >
                           std::chrono::abs(recorded - messages[*last].recorded);
    if (segments.empty() || jumps) {
      close(i);
      segments.push_back({{i, i}});
    }
    if (!header) continue;
    last = i;
    offsets.push_back(*header - recorded);
  }
  close(messages.size());
  return segments;
}

const Segment& longest(const std::vector<Segment>& segments) {
  return *std::ranges::max_element(segments, {}, [](const Segment& each) { return each.piece.size(); });
}

/// First and last moment of something, with room for messages between two of it.
struct Span {
  Stamp first{Duration::max()};
  Stamp last{Duration::min()};

  void include(Stamp stamp) {
    first = std::min(first, stamp);
    last = std::max(last, stamp);
  }
  [[nodiscard]] bool holds(Stamp stamp) const { return stamp >= first - kBack && stamp <= last + kBack; }
};

std::string seconds(Duration duration) { return fmt::format("{:.1f} s", std::abs(to_seconds(duration))); }

const char* ahead_or_behind(Duration offset) { return offset > Duration{0} ? "ahead of" : "behind"; }

bool has_headers(const Messages& messages) {
  return std::ranges::any_of(messages, [](const MessageTime& message) { return message.header.has_value(); });
}

/// When a message was made by the clock of its headers.
Stamp own_stamp(const MessageTime& message, const Segment& segment) {
  return message.header.value_or(message.recorded + segment.offset);
}

/// Puts the messages of all topics on the clock of the first.
class Chronology {
 public:
  explicit Chronology(std::vector<TopicTimes> topics) : topics_(std::move(topics)) {}

  TimeOrder run(bool by_header) {
    for (TopicTimes& topic : topics_) {
      forget_nonsense(topic.messages);
      if (!by_header) forget_headers(topic);
      drop_repeated(topic);
      thaw_stamps(topic);
    }
    undo_setting_back();
    for (std::size_t k = 0; k < topics_.size(); ++k) place(k);
    return std::move(order_);
  }

 private:
  /// The clock that the others are put on.
  struct Reference {
    std::string name;
    Duration offset{0};
    bool has_headers = false;
    Span stamps;
    Span recorded;
  };

  static void forget_nonsense(Messages& messages) {
    const auto is_far = [](Stamp stamp) { return std::chrono::abs(stamp.since_epoch) > kLatest; };
    for (MessageTime& message : messages) {
      if (is_far(message.recorded)) message.recorded = Stamp{};
      if (message.header && is_far(*message.header)) message.header.reset();
    }
  }

  static void forget_headers(TopicTimes& topic) {
    for (MessageTime& message : topic.messages) {
      message.header.reset();
      message.expects_a_header = false;
    }
  }

  void count(std::size_t messages, const std::string& topic, std::string_view what) {
    if (messages > 0) note(fmt::format("messages of {} {}: {}", topic, what, messages));
  }
  void note(std::string line) { add_note(order_.notes, std::move(line)); }

  void drop_repeated(TopicTimes& topic) {
    auto& stamps = order_.stamps.emplace_back(topic.messages.size(), Stamp{});
    const auto repeated = find_repeated(topic.messages);
    Messages kept;
    for (std::size_t i = 0; i < repeated.size(); ++i)
      if (repeated[i])
        stamps[i] = TimeOrder::kSkipped;
      else
        kept.push_back(topic.messages[i]);
    count(repeated.size() - kept.size(), topic.name, "skipped that are there twice");
    topic.messages = std::move(kept);
  }

  void thaw_stamps(TopicTimes& topic) {
    count(thaw(topic.messages), topic.name,
          "whose stamp stands still, moved on as the times of recording are");
  }

  /// The topic with most messages tells best by how much. What went back without it is no clock.
  void undo_setting_back() {
    const auto most =
        std::ranges::max_element(topics_, {}, [](const TopicTimes& topic) { return topic.messages.size(); });
    if (most == topics_.end()) return;
    const auto measured = find_set_back(most->messages);
    if (measured.empty()) return;
    for (const auto& [at, by] : measured) note_set_back(*most, at, by);
    for (TopicTimes& topic : topics_)
      for (const SetBack& step : find_set_back(topic.messages)) {
        const auto off = [&step](const SetBack& other) { return std::chrono::abs(other.by - step.by); };
        const SetBack& nearest = *std::ranges::min_element(measured, {}, off);
        if (off(nearest) < kJump) undo({step.at, nearest.by}, topic.messages);
      }
  }

  void note_set_back(const TopicTimes& topic, std::size_t at, Duration by) {
    note(
        fmt::format("the clock of the recording was set back by {} when {} had {} messages: what comes "
                    "behind is moved on by as much",
                    seconds(by), topic.name, at));
  }

  /// Stamps the messages of a topic that are left.
  void place(std::size_t k) {
    TopicTimes& topic = topics_[k];
    if (topic.messages.empty()) return;
    const auto segments = find_segments(topic.messages);
    const bool has_whole =
        std::ranges::any_of(segments, [](const Segment& each) { return !is_single(each); });
    std::size_t jumps = 0, headless = 0;
    std::vector<Stamp> stamps;
    if (!reference_) refer_to(topic, longest(segments));
    for (const Segment& segment : segments) {
      const bool skipped = has_whole && is_single(segment) && segments.size() > 1;
      const Duration shift = skipped ? Duration{0} : shift_of(topic, segment);
      for (const MessageTime& message : part(topic.messages, segment.piece)) {
        stamps.push_back(skipped ? TimeOrder::kSkipped : own_stamp(message, segment) + shift);
        if (message.expects_a_header && !message.header && message.recorded != Stamp{}) ++headless;
      }
      if (skipped) ++jumps;
    }
    count(headless, topic.name, "without a stamp in the header, placed at their time of recording");
    count(jumps, topic.name,
          "skipped whose stamp jumps by more than 10 s relative to the time of recording "
          "(input.stamps=recorded uses the latter)");
    auto next = stamps.begin();
    for (Stamp& stamp : order_.stamps[k])
      if (stamp != TimeOrder::kSkipped) stamp = *next++;
    Messages().swap(topic.messages);
  }

  static bool is_single(const Segment& segment) { return segment.piece.size() == 1; }

  void refer_to(const TopicTimes& topic, const Segment& segment) {
    reference_ = {topic.name, segment.offset, has_headers(topic.messages), {}, {}};
    for (const MessageTime& message : part(topic.messages, segment.piece))
      reference_->stamps.include(own_stamp(message, segment));
    for (const MessageTime& message : topic.messages) reference_->recorded.include(message.recorded);
    for (const Stamp recorded : {reference_->recorded.first, reference_->recorded.last})
      reference_->stamps.include(recorded + segment.offset);
  }

  /// What brings a segment's stamps onto the clock of reference.
  Duration shift_of(const TopicTimes& topic, const Segment& segment) {
    const Duration ahead = segment.offset - reference_->offset;
    if (topic.name == reference_->name) {
      if (std::chrono::abs(ahead) <= kJump) return Duration{0};
      note(fmt::format(
          "some stamps of {} are {} {} the others, relative to the times of recording: its clock "
          "was set; they are moved by as much (input.stamps=recorded uses the times of recording)",
          topic.name, seconds(ahead), ahead_or_behind(ahead)));
      return -ahead;
    }
    const auto messages = part(topic.messages, segment.piece);
    const auto beside = std::ranges::count_if(messages, [&](const MessageTime& message) {
      return reference_->stamps.holds(own_stamp(message, segment));
    });
    const auto recorded_beside = std::ranges::count_if(
        messages, [&](const MessageTime& message) { return reference_->recorded.holds(message.recorded); });
    if (2 * beside < recorded_beside) {
      note(
          fmt::format("the stamps of {} are {} {} those of {}: another clock; they are moved by as much "
                      "(input.stamps=recorded uses the times of recording of all topics)",
                      topic.name, seconds(ahead), ahead_or_behind(ahead), reference_->name));
      return -ahead;
    }
    if (std::chrono::abs(ahead) > kBack && reference_->has_headers && has_headers(topic.messages))
      note(
          fmt::format("the stamps of {} are {} {} those of {}, relative to the times of recording: they are "
                      "believed; if the clocks disagree, set input.stamps=recorded",
                      topic.name, seconds(ahead), ahead_or_behind(ahead), reference_->name));
    return Duration{0};
  }

  std::vector<TopicTimes> topics_;
  TimeOrder order_;
  std::optional<Reference> reference_;
};

}  // namespace

TimeOrder find_time_order(std::vector<TopicTimes> topics, bool by_header) {
  return Chronology(std::move(topics)).run(by_header);
}

std::vector<Stamp> earliest_from(const std::vector<Stamp>& stamps) {
  std::vector<Stamp> earliest = stamps;
  for (std::size_t i = earliest.size(); i-- > 1;) earliest[i - 1] = std::min(earliest[i - 1], earliest[i]);
  return earliest;
}

Duration disorder(const TimeOrder& order, std::span<const std::uint32_t> sequence) {
  std::vector<std::size_t> next(order.stamps.size(), 0);
  Stamp newest{Duration::min()};
  Duration most{0};
  for (const std::uint32_t topic : sequence) {
    const Stamp stamp = order.stamps[topic][next[topic]++];
    if (stamp == TimeOrder::kSkipped) continue;
    if (stamp < newest) most = std::max(most, newest - stamp);
    newest = std::max(newest, stamp);
  }
  return most;
}

}  // namespace waymark::bag
