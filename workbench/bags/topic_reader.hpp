#pragma once

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "waymark/core/event.hpp"
#include "waymark/core/result.hpp"

#include "workbench/bags/message_decoder.hpp"

namespace waymark::bag {

/// How the messages of one topic become events.
struct TopicReader {
  MessageDecoder decoder;
  bool has_header = true;  ///< numbers 0 and 1 of the decoder are its stamp, in s and ns
  /// The content of the message that the decoder has just read, or why it can not be used.
  std::function<Result<EventContent>(const MessageDecoder&)> content;
  /// What `content` left out or guessed in the messages so far, one line each; may be empty.
  std::function<std::vector<std::string>()> content_notes = {};

  /// What the header says; nothing where there is none, or one that was left at zero or makes no sense.
  [[nodiscard]] std::optional<Stamp> stamp() const;
  /// Those of the decoder and of the content.
  [[nodiscard]] std::vector<std::string> notes() const;
};

/// The numbers that every message with a header has first.
[[nodiscard]] std::vector<std::string> after_stamp(std::vector<std::string> numbers);

/// The paths of all `names` below `path`.
[[nodiscard]] std::vector<std::string> below(std::string_view path,
                                             std::initializer_list<std::string_view> names);

}  // namespace waymark::bag
