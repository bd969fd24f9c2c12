#pragma once

#include <string>

namespace waymark {

/// JSON as text, on one line or with `indent` blanks per level. Names of files, topics and landmarks are
/// bytes of any kind, JSON is UTF-8: what is not becomes the replacement character U+FFFD.
template <class Json>
[[nodiscard]] std::string json_text(const Json& json, int indent = -1) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

}  // namespace waymark
