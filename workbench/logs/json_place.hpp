#pragma once

#include <cmath>
#include <cstddef>
#include <limits>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "workbench/logs/json_text.hpp"

namespace waymark {

/// What is wrong in a JSON text, and where: "landmarks[3].number: 4294967297 is not a whole number from ...".
struct JsonError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// A value in a JSON text that knows where it stands. Values of another type or beyond the asked one are a
/// JsonError, where the library would convert them in silence. Valid as long as the text.
template <class Json>
class JsonPlace {
 public:
  explicit JsonPlace(const Json& json, std::string path = "") : json_(json), path_(std::move(path)) {}

  [[nodiscard]] JsonPlace at(const char* key) const {
    if (!json_.is_object() || !json_.contains(key)) fail(fmt::format("{} is missing", key));
    return JsonPlace(json_.at(key), path_.empty() ? key : fmt::format("{}.{}", path_, key));
  }

  /// Of a list.
  [[nodiscard]] std::vector<JsonPlace> items() const {
    if (!json_.is_array()) fail("is not a list");
    std::vector<JsonPlace> all;
    all.reserve(json_.size());
    for (const Json& item : json_) all.emplace_back(item, fmt::format("{}[{}]", path_, all.size()));
    return all;
  }

  /// Of a list that must have so many.
  [[nodiscard]] std::vector<JsonPlace> items(std::size_t count) const {
    auto all = items();
    if (all.size() != count) fail(fmt::format("has {} items; expected {}", all.size(), count));
    return all;
  }

  [[nodiscard]] double number() const {
    if (!json_.is_number()) fail("is not a number");
    return json_.template get<double>();
  }

  template <class Integer>
  [[nodiscard]] Integer whole() const {
    using Limits = std::numeric_limits<Integer>;
    static_assert(Limits::digits < 53, "doubles hold it exactly");
    const double value = number();
    if (std::trunc(value) != value || value < double{Limits::min()} || value > double{Limits::max()})
      fail(fmt::format("{} is not a whole number from {} to {}", json_text(json_), Limits::min(),
                       Limits::max()));
    return static_cast<Integer>(value);
  }

  [[nodiscard]] std::string text() const {
    if (!json_.is_string()) fail("is not a text");
    return json_.template get<std::string>();
  }

  [[noreturn]] void fail(std::string_view what) const {
    throw JsonError(path_.empty() ? std::string(what) : fmt::format("{}: {}", path_, what));
  }

 private:
  const Json& json_;
  std::string path_;
};

}  // namespace waymark
