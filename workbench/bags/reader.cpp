#include "workbench/bags/reader.hpp"

#include <algorithm>
#include <utility>

namespace waymark::bag {

std::string plain_type(std::string_view type) {
  std::string plain(type);
  const auto replace_all = [&plain](std::string_view old, std::string_view by) {
    for (auto place = plain.find(old); place != std::string::npos; place = plain.find(old, place + by.size()))
      plain.replace(place, old.size(), by);
  };
  replace_all("::", "/");
  if (plain.find("/dds_/") != std::string::npos && plain.ends_with('_')) plain.pop_back();
  replace_all("/dds_/", "/");
  replace_all("/msg/", "/");
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
