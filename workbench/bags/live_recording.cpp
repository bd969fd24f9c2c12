#include "workbench/bags/live_recording.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "workbench/bags/image_messages.hpp"
#include "workbench/bags/open_bag.hpp"
#include "workbench/config/flat_yaml.hpp"
#include "workbench/logs/files.hpp"
#include "workbench/logs/json_event.hpp"

namespace waymark {
namespace {

using Json = nlohmann::json;

constexpr std::string_view kEvents = "/waymark/events";
constexpr std::string_view kImages = "/camera/image/compressed";

std::optional<std::size_t> find_topic(const bag::Summary& summary, std::string_view name) {
  const auto found = std::ranges::find(summary.topics, name, &bag::Topic::name);
  if (found == summary.topics.end()) return std::nullopt;
  return static_cast<std::size_t>(found - summary.topics.begin());
}

std::optional<std::string> text_at(const Json& json, const char* name) {
  const auto found = json.find(name);
  return found != json.end() && found->is_string() ? std::optional(found->get<std::string>()) : std::nullopt;
}

std::optional<Stamp> stamp_at(const Json& json, const char* name) {
  const auto text = text_at(json, name);
  return text ? parse_stamp(*text) : std::nullopt;
}

StreamId stream_of(const Json& json) {
  const auto found = json.find("device");
  const bool is_one = found != json.end() && found->is_number_unsigned() &&
                      found->get<std::uint64_t>() <= std::numeric_limits<std::uint16_t>::max();
  return {0, is_one ? found->get<std::uint16_t>() : std::uint16_t{0}};
}

class LiveRecording final : public Source {
 public:
  LiveRecording(std::unique_ptr<bag::Reader> bag, std::string file)
      : bag_(std::move(bag)), file_(std::move(file)) {}

  /// Looks for the config, which is the first event, and begins.
  [[nodiscard]] Result<void> begin() {
    const bag::Summary& summary = bag_->summary();
    events_ = *find_topic(summary, kEvents);
    std::vector<bool> wanted(summary.topics.size(), false);
    wanted[events_] = true;
    if (const auto images = find_topic(summary, kImages)) {
      auto reader = bag::image_reader(summary.topics[*images]);
      if (!reader) return reader.error();
      image_reader_ = *std::move(reader);
      wanted[*images] = true;
    }
    bag_->rewind(std::move(wanted));
    const auto first = bag_->next();
    const Json json = first ? Json::parse(first->bytes, nullptr, false) : Json();
    const auto config = text_at(json, "config");
    if (!config) return Error{fmt::format("{}: the recording does not begin with its config", file_)};
    const auto settings = flatten_yaml(*config, file_);
    if (!settings) return settings.error();
    info_.name = text_at(json, "session").value_or(file_);
    for (const auto& [key, value, line] : *settings) info_.settings.emplace_back(key, value);
    return {};
  }

  [[nodiscard]] const LogInfo& info() const override { return info_; }

  [[nodiscard]] Result<std::optional<Event>> next() override {
    until_.reset();
    while (const auto message = bag_->next()) {
      auto event = message->topic == events_ ? take_event(message->bytes) : take_image(message->bytes);
      if (!event || *event) return event;
    }
    return std::optional<Event>{};
  }

  [[nodiscard]] std::optional<Replay> replay() const override { return Replay{until_}; }
  [[nodiscard]] std::vector<std::string> notes() const override { return bag_->notes(); }
  [[nodiscard]] double progress() const override { return bag_->progress(); }

 private:
  [[nodiscard]] Error damaged(const std::string& why) const {
    return Error{fmt::format("{}: {}: {}", file_, kEvents, why)};
  }

  Result<std::optional<Event>> take_event(std::string_view bytes) {
    const Json json = Json::parse(bytes, nullptr, false);
    if (!json.is_object()) return damaged("a message is not a JSON object");
    if (json.contains("until")) {
      until_ = stamp_at(json, "until");
      return std::optional<Event>{};
    }
    if (json.contains("image")) {
      image_ = std::pair(stamp_at(json, "image").value_or(Stamp{}), stream_of(json));
      return std::optional<Event>{};
    }
    auto read = parse_json_event(bytes);
    if (!read) return damaged(read.error().message);
    return std::optional(Event(read->stamp.value_or(Stamp{}), stream_of(json), std::move(read->content)));
  }

  Result<std::optional<Event>> take_image(std::string_view bytes) {
    if (!image_ || !image_reader_) return std::optional<Event>{};
    if (auto read = image_reader_->decoder.decode(bytes); !read) return read.error();
    auto content = image_reader_->content(image_reader_->decoder);
    if (!content) return content.error();
    const auto [stamp, stream] = *std::exchange(image_, std::nullopt);
    return std::optional(Event(stamp, stream, *std::move(content)));
  }

  std::unique_ptr<bag::Reader> bag_;
  std::string file_;
  LogInfo info_{.name = "", .format = "live recording"};
  std::size_t events_ = 0;
  std::optional<bag::TopicReader> image_reader_;
  std::optional<std::pair<Stamp, StreamId>> image_;  // whose message comes next
  std::optional<Stamp> until_;                       // told since the event before
};

}  // namespace

bool is_live_recording(const std::filesystem::path& path) {
  if (path.extension() != ".mcap") return false;
  const auto bag = bag::open_bag(path);
  return bag && find_topic((*bag)->summary(), kEvents);
}

Result<std::unique_ptr<Source>> open_live_recording(const std::filesystem::path& path) {
  auto bag = bag::open_bag(path);
  if (!bag) return bag.error();
  auto recording = std::make_unique<LiveRecording>(*std::move(bag), base_name(path));
  if (auto begun = recording->begin(); !begun) return begun.error();
  return std::unique_ptr<Source>(std::move(recording));
}

}  // namespace waymark
