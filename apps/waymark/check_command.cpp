#include <algorithm>
#include <cstdio>
#include <map>
#include <memory>
#include <set>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "commands.hpp"
#include "workbench/eval/truth_check.hpp"
#include "workbench/logs/image_loader.hpp"
#include "workbench/logs/json_text.hpp"
#include "workbench/report/results.hpp"
#include "workbench/run/check_gaps.hpp"
#include "workbench/run/check_gyro.hpp"
#include "workbench/run/check_jumps.hpp"
#include "workbench/run/check_log.hpp"

namespace waymark::app {
namespace {

struct CheckRequest {
  std::string input;
  SettingsFlags flags;
  Verbosity verbosity;
};

/// One kind of event in a log.
struct Stream {
  std::int64_t events = 0;
  Stamp first;
  Stamp last;
  Duration longest_gap{0};

  void see(Stamp stamp) {
    if (events++ == 0)
      first = stamp;
    else
      longest_gap = std::max(longest_gap, stamp - last);
    last = stamp;
  }
  [[nodiscard]] double duration_s() const { return to_seconds(last - first); }
  [[nodiscard]] double rate_hz() const {
    return duration_s() > 0.0 ? static_cast<double>(events - 1) / duration_s() : 0.0;
  }
};

/// Everything that one pass over a log shows.
struct Contents {
  std::map<std::string, Stream> streams;  ///< by name
  std::map<LandmarkId, std::int64_t> observations;
  std::int64_t unidentified = 0;
  std::optional<ImageSize> image_size;  ///< of the last image
  std::int64_t blank_images = 0;
  std::set<std::string> measured;  ///< "range and bearing", ...
  std::vector<eval::PositionObservation> placed;
  std::vector<eval::TruthSample> truth;
  LogSample sample;
  std::vector<OdometryGap> gaps;
  std::optional<Stamp> start;
  std::vector<std::string> notes;
  std::optional<Error> error;
};

const char* name_of(const EventContent& content) {
  static constexpr std::array kNames{"wheel angles",   "velocity",     "steering",
                                     "odometry poses", "yaw rates",    "images",
                                     "marker corners", "observations", "ground truth"};
  static_assert(kNames.size() == std::variant_size_v<EventContent>);
  return kNames[content.index()];
}

const char* kind_of(const Measurement& value) {
  static constexpr std::array kKinds{"range and bearing", "range", "bearing", "pixel"};
  return kKinds[value.index()];
}

void look_at(const Observations& observations, Stamp stamp, const Pose2& T_robot_sensor, Contents& contents) {
  for (const Observation& observation : observations) {
    contents.measured.insert(kind_of(observation.value));
    if (!observation.id) {
      ++contents.unidentified;
      continue;
    }
    ++contents.observations[*observation.id];
    if (const auto* z = std::get_if<RangeBearing>(&observation.value)) {
      const Eigen::Vector2d ray(std::cos(z->bearing_rad), std::sin(z->bearing_rad));
      contents.placed.push_back({stamp, *observation.id, T_robot_sensor * Eigen::Vector2d(z->range_m * ray)});
    }
  }
}

/// Nothing can be found in an image all of whose pixels are alike: a covered lens, an image all black or
/// white.
void look_at(const GreyImage& image, Contents& contents) {
  constexpr int kMinContrast = 24;
  contents.image_size = {image.width_px(), image.height_px()};
  const auto count = static_cast<std::size_t>(image.width_px()) * static_cast<std::size_t>(image.height_px());
  const auto [darkest, lightest] = std::minmax_element(image.data(), image.data() + count);
  if (*lightest - *darkest < kMinContrast) ++contents.blank_images;
}

Contents read_contents(Source& source, const Config& config) {
  Contents contents;
  GapSearch gaps(config.pipeline.max_hold_s);
  while (true) {
    auto event = source.next();
    if (!event) {
      contents.error = event.error();
      break;
    }
    if (!*event) break;
    const auto& [stamp, stream, content] = **event;
    if (!contents.start) contents.start = stamp;
    contents.streams[name_of(content)].see(stamp);
    contents.sample.add(**event, config.sensor);
    gaps.add(**event);
    if (const auto* observations = std::get_if<Observations>(&content))
      look_at(*observations, stamp, config.sensor.T_robot_sensor(), contents);
    if (const auto* image = std::get_if<Image>(&content)) look_at(*image->pixels, contents);
    if (const auto* truth = std::get_if<Truth>(&content)) contents.truth.push_back({stamp, *truth});
  }
  contents.gaps = gaps.found();
  contents.notes = source.notes();
  return contents;
}

/// Landmarks of the survey that the observations contradict: by the true path where there is one, else by the
/// map that a filter makes of the log.
std::vector<std::string> survey_oddities(const CheckRequest& request, const LogInfo& log,
                                         const Contents& contents) {
  if (log.landmarks.empty() || contents.placed.empty()) return {};
  const Eigen::Vector2d truth_sensor_m = log.truth_sensor_m.value_or(Eigen::Vector2d::Zero());
  if (!contents.truth.empty()) {
    const auto seen =
        eval::place_observations(contents.placed, eval::TruthTrack(contents.truth), truth_sensor_m);
    return describe(eval::find_oddities(seen, log.landmarks, Pose2{}));
  }
  const auto result = run_log(request.input, request.flags.settings());
  if (!result) return {};
  return describe(eval::compare_maps(result->recording.filter->snapshot().landmarks, log.landmarks));
}

std::vector<std::string> find_oddities(const CheckRequest& request, const Config& config, const LogInfo& log,
                                       const Contents& contents) {
  std::vector<std::string> oddities = contents.notes;
  for (const auto& [name, stream] : contents.streams)
    if (name != "ground truth" && name != "observations" && to_seconds(stream.longest_gap) > 1.0)
      oddities.push_back(fmt::format("{}: longest gap {:.2f} s", name, to_seconds(stream.longest_gap)));
  if (contents.unidentified > 0)
    oddities.push_back(fmt::format("{} observations of unknown identity", contents.unidentified));
  if (contents.blank_images > 0)
    oddities.push_back(
        fmt::format("{} images show nothing: all pixels are nearly equal", contents.blank_images));
  const Stamp start = contents.start.value_or(Stamp{});
  std::ranges::move(describe(contents.gaps, start, config.pipeline.max_hold_s), std::back_inserter(oddities));
  std::ranges::move(describe(jumps_of(contents.sample, config), start), std::back_inserter(oddities));
  std::ranges::move(describe(gyro_of(contents.sample, config), start), std::back_inserter(oddities));
  std::ranges::move(contradictions_in(contents.sample, config), std::back_inserter(oddities));
  std::ranges::move(survey_oddities(request, log, contents), std::back_inserter(oddities));
  return oddities;
}

/// What to run on it, or why nothing can be run.
std::string advice(const CheckRequest& request, const Config& config, const LogInfo& log,
                   const Contents& contents) {
  const auto has = [&contents](const char* name) { return contents.streams.contains(name); };
  if (!has("wheel angles") && !has("velocity") && !has("steering") && !has("odometry poses"))
    return describe_missing_odometry(log);
  if (!has("observations") && !has("images") && !has("marker corners"))
    return "only dead reckoning can be run: there are no observations";
  if (log.only_pixels && !config.camera_known)
    return log.topics.empty()
               ? "nothing can be run: the camera is not calibrated: camera.yaml is missing"
               : "nothing can be run: the camera is not calibrated; `waymark calibrate camera PHOTOS -o "
                 "camera` writes a calibration, for --set input.camera_file=camera/camera.yaml";
  std::string command = "waymark run " + request.input;
  for (const auto& more : request.flags.more_inputs) command += " " + more;
  command += " -o out";
  if (log.only_pixels) command += " --observe pixel";
  if (has("marker corners")) command += " --set markers.size_m=SIDE";
  for (const auto& assignment : request.flags.assignments) command += " --set " + assignment;
  return command;
}

double rate_hz(const LogTopic& topic, const LogInfo& log) {
  if (topic.messages == 0 || log.recorded_s <= 0.0) return 0.0;
  return static_cast<double>(topic.messages - 1) / log.recorded_s;
}

void print_topics(const LogInfo& log) {
  std::size_t width = 0;
  for (const auto& topic : log.topics) width = std::max(width, topic.name.size() + topic.type.size() + 3);
  for (const auto& topic : log.topics)
    fmt::print("  {:<{}} {:>8} messages  {:>7.1f} Hz  {}\n", fmt::format("{} ({})", topic.name, topic.type),
               width, topic.messages, rate_hz(topic, log), topic.use.empty() ? "not used" : topic.use);
}

void print_log_text(const LogInfo& log, const Contents& contents, const std::vector<std::string>& oddities,
                    const std::string& next) {
  fmt::print("{} ({})\n", log.name, log.format);
  print_topics(log);
  for (const auto& [name, stream] : contents.streams)
    fmt::print("  {:<16}{:>8} events  {:>8.1f} s  {:>7.1f} Hz  longest gap {:.2f} s\n", name, stream.events,
               stream.duration_s(), stream.rate_hz(), to_seconds(stream.longest_gap));
  for (const auto& kind : contents.measured) fmt::print("  observed: {}\n", kind);
  if (const auto& size = contents.image_size)
    fmt::print("  image size: {} x {} pixels\n", size->width_px, size->height_px);
  if (!contents.observations.empty()) {
    fmt::print("  identities: {}:", contents.observations.size());
    for (const auto& [id, count] : contents.observations) fmt::print(" {} ({}x)", to_string(id), count);
    fmt::print("\n");
  }
  fmt::print("  surveyed landmarks: {}\n", log.landmarks.size());
  for (const auto& [key, value] : log.settings) fmt::print("  the log sets {} = {}\n", key, value);
  for (const auto& oddity : oddities) fmt::print("  odd: {}\n", oddity);
  fmt::print("run: {}\n", next);
}

void print_log_json(const LogInfo& log, const Contents& contents, const std::vector<std::string>& oddities,
                    const std::string& next) {
  nlohmann::ordered_json json{{"name", log.name}, {"format", log.format}};
  for (const auto& [name, stream] : contents.streams)
    json["streams"].push_back({{"name", name},
                               {"events", stream.events},
                               {"duration_s", stream.duration_s()},
                               {"rate_hz", stream.rate_hz()},
                               {"longest_gap_s", to_seconds(stream.longest_gap)}});
  for (const auto& topic : log.topics)
    json["topics"].push_back({{"name", topic.name},
                              {"type", topic.type},
                              {"messages", topic.messages},
                              {"rate_hz", rate_hz(topic, log)},
                              {"use", topic.use}});
  json["observed"] = contents.measured;
  if (const auto& size = contents.image_size) json["image_size"] = {size->width_px, size->height_px};
  json["identities"] = nlohmann::ordered_json::object();
  for (const auto& [id, count] : contents.observations) json["identities"][to_string(id)] = count;
  json["surveyed_landmarks"] = log.landmarks.size();
  json["settings"] = nlohmann::ordered_json::object();
  for (const auto& [key, value] : log.settings) json["settings"][key] = value;
  json["odd"] = oddities;
  json["run"] = next;
  fmt::print("{}\n", json_text(json, 2));
}

Result<void> check_log(const CheckRequest& request) {
  auto opened = open_input(request.input, request.flags.settings());
  if (!opened) return opened.error();
  ImageLoader source(std::move(opened->source));
  const Contents contents = read_contents(source, opened->config);
  const LogInfo& log = source.info();
  const auto oddities = find_oddities(request, opened->config, log, contents);
  const std::string next = advice(request, opened->config, log, contents);
  (request.verbosity.json ? print_log_json : print_log_text)(log, contents, oddities, next);
  if (contents.error) return *contents.error;
  return {};
}

}  // namespace

void add_check(CLI::App& app, Work& work) {
  auto* command = app.add_subcommand(
      "check", "List what a log contains, what is missing or odd in it, and the command to run on it");
  auto request = std::make_shared<CheckRequest>();
  command
      ->add_option("input", request->input,
                   "a log folder, a ROS bag (or several of one drive), a published data set, or sim:SCENARIO")
      ->required()
      ->type_name("LOG");
  request->flags.add_to(*command);
  command->add_flag("--json", request->verbosity.json,
                    "print the findings as JSON on standard output and nothing else there");
  command->footer("Example:\n  waymark check MRCLAM_Dataset1 --set input.robot=2");
  command->allow_extras();
  command->callback([&work, request, command] {
    request->flags.take_more_inputs(*command, request->input);
    work = [request] { return check_log(*request); };
  });
}

}  // namespace waymark::app
