#include "workbench/bags/reader.hpp"

#include <algorithm>
#include <utility>

namespace waymark::bag {

std::string plain_type(std::string_view type) {
  constexpr std::string_view kMiddle = "/msg/";
  std::string plain(type);
  if (const auto place = plain.find(kMiddle); place != std::string::npos)
    plain.replace(place, kMiddle.size(), "/");
  return plain;
}

std::size_t place_topic(std::vector<Topic>& topics, Topic topic) {
  const auto found = std::ranges::find_if(topics, [&topic](const Topic& other) {
    return other.name == topic.name && other.type == topic.type && other.encoding == topic.encoding;
  });
  const auto place = static_cast<std::size_t>(found - topics.begin());
  if (found == topics.end()) topics.push_back(std::move(topic));
  return place;
}

void include(Summary& summary, Stamp stamp) {
  summary.first = std::min(summary.first.value_or(stamp), stamp);
  summary.last = std::max(summary.last.value_or(stamp), stamp);
}

void add_note(std::vector<std::string>& notes, std::string note) {
  if (std::ranges::find(notes, note) == notes.end()) notes.push_back(std::move(note));
}

}  // namespace waymark::bag
