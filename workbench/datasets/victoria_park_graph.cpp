#include "workbench/datasets/victoria_park_graph.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "waymark/models/odometry.hpp"

#include "workbench/datasets/vehicle_log.hpp"
#include "workbench/datasets/victoria_park.hpp"
#include "workbench/logs/event_list.hpp"
#include "workbench/logs/text_lines.hpp"

namespace waymark {
namespace {

namespace fs = std::filesystem;

/// How far the vehicle had gone at each scan of the log, by its own measure.
class Mileage {
 public:
  void add(Stamp stamp, const Steering& steering) {
    travelled_m_ += moved_m(stamp);
    held_ = {stamp, steering};
  }
  void add_scan(Stamp stamp) { scans_.push_back({stamp, travelled_m_ + moved_m(stamp)}); }

  [[nodiscard]] bool empty() const { return scans_.empty(); }

  /// The scans of poses that had gone so far, one each: of those where it stood the graph has none.
  [[nodiscard]] std::vector<Stamp> stamps_of(const std::vector<double>& gone_m) const {
    std::vector<Stamp> stamps;
    auto next = scans_.begin();
    for (const double travelled_m : gone_m) {
      next = std::ranges::lower_bound(next, scans_.end(), travelled_m, {}, &Scan::travelled_m);
      if (next == scans_.end()) --next;
      stamps.push_back(next->stamp);
      if (std::next(next) != scans_.end()) ++next;
    }
    return stamps;
  }

 private:
  struct Scan {
    Stamp stamp;
    double travelled_m;
  };

  [[nodiscard]] double moved_m(Stamp until) const {
    constexpr CarGeometry kCar{2.83, 0.76};  // with which the graph was made
    if (!held_) return 0.0;
    const auto& [since, steering] = *held_;
    return std::abs(
        car_step(steering.v_mps * to_seconds(until - since), steering.steer_rad, kCar).distance_m);
  }

  std::vector<Scan> scans_;
  double travelled_m_ = 0.0;
  std::optional<std::pair<Stamp, Steering>> held_;
};

/// One kind of line of the graph.
struct EdgeLine {
  std::string_view kind;
  std::size_t numbers;
  std::string_view meaning;
};

constexpr EdgeLine kOdometryLine{"ODOMETRY", 11, "two poses, dx, dy, dtheta and 6 of covariance"};
constexpr EdgeLine kLandmarkLine{"LANDMARK", 7, "a pose, a landmark, dx, dy and 3 of covariance"};

Result<std::vector<double>> read_numbers(std::string_view rest, const EdgeLine& layout,
                                         const TextLines& lines) {
  std::vector<double> numbers;
  for (auto word = take_word(rest); !word.empty(); word = take_word(rest)) {
    const auto number = parse_number(word);
    if (!number || !std::isfinite(*number)) return lines.error(in_quotes(word) + " is not a number");
    numbers.push_back(*number);
  }
  if (numbers.size() == layout.numbers) return numbers;
  return lines.error(fmt::format("expected {} numbers after {}: {}; found {}", layout.numbers, layout.kind,
                                 layout.meaning, numbers.size()));
}

/// The graph as it stands in the file.
struct Graph {
  struct Pose {
    Pose2 T_odom_robot;
    double travelled_m = 0.0;  ///< from the first
    Observations seen;
  };
  std::vector<Pose> poses{Pose{}};
  std::map<double, std::size_t> index_of_key{{0.0, 0}};  ///< poses and landmarks share one count

  /// False: the pose before is unknown, or the new one is not new.
  bool add_odometry(const std::vector<double>& n) {
    const auto before = index_of_key.find(n[0]);
    if (before == index_of_key.end() || before->second + 1 != poses.size()) return false;
    if (!index_of_key.emplace(n[1], poses.size()).second) return false;
    const Pose& last = poses.back();
    const Pose2 moved{n[2], n[3], wrap_angle(n[4])};
    poses.push_back({last.T_odom_robot * moved, last.travelled_m + moved.position().norm(), {}});
    return true;
  }

  /// False: the pose is unknown, or the landmark has no number.
  bool add_landmark(const std::vector<double>& n) {
    constexpr double kMost = 1e9;
    const auto pose = index_of_key.find(n[0]);
    if (pose == index_of_key.end() || n[1] < 0.0 || n[1] > kMost) return false;
    const Eigen::Vector2d from_laser_m = Eigen::Vector2d(n[2], n[3]) - kVehicleLaser_m;
    const LandmarkId id{LandmarkId::Family::kMarker, static_cast<std::int32_t>(n[1])};
    poses[pose->second].seen.push_back(
        {id, RangeBearing{from_laser_m.norm(), std::atan2(from_laser_m.y(), from_laser_m.x())},
         std::nullopt});
    return true;
  }
};

Result<void> read_graph_line(const TextLines& lines, Graph& graph) {
  std::string_view rest = lines.line();
  const std::string_view kind = take_word(rest);
  const bool is_odometry = kind == kOdometryLine.kind;
  if (!is_odometry && kind != kLandmarkLine.kind)
    return lines.error(in_quotes(kind) + " is not a known kind of line; expected ODOMETRY or LANDMARK");
  const auto numbers = read_numbers(rest, is_odometry ? kOdometryLine : kLandmarkLine, lines);
  if (!numbers) return numbers.error();
  if (is_odometry && !graph.add_odometry(*numbers))
    return lines.error("does not go from the last pose to a new one");
  if (!is_odometry && !graph.add_landmark(*numbers))
    return lines.error("refers to an unknown pose or landmark");
  return {};
}

Result<Graph> read_graph(const fs::path& file) {
  auto lines = TextLines::open(file);
  if (!lines) return lines.error();
  Graph graph;
  while (lines->next())
    if (auto done = read_graph_line(*lines, graph); !done) return done.error();
  return graph;
}

/// What the log beside the graph tells.
struct Log {
  Mileage mileage;
  std::vector<Event> truth;
  std::vector<std::string> notes;
};

Result<Log> read_log(const fs::path& path) {
  const auto file = MatFile::open(path);
  if (!file) return file.error();
  const auto source = open_victoria_park(*file);
  if (!source) return source.error();
  Log log{{}, {}, (*source)->notes()};
  while (true) {
    auto event = (*source)->next();
    if (!event) return event.error();
    if (!*event) return log;
    if (const auto* steering = std::get_if<Steering>(&(*event)->content))
      log.mileage.add((*event)->stamp, *steering);
    if (std::holds_alternative<Observations>((*event)->content)) log.mileage.add_scan((*event)->stamp);
    if (std::holds_alternative<Truth>((*event)->content)) log.truth.push_back(**std::move(event));
  }
}

/// Of the poses, from the log where there is one.
std::vector<Stamp> stamps_of(const Graph& graph, const Log& log) {
  constexpr double kScan_s = 0.2;
  std::vector<double> gone_m;
  for (const auto& pose : graph.poses) gone_m.push_back(pose.travelled_m);
  if (!log.mileage.empty()) return log.mileage.stamps_of(gone_m);
  std::vector<Stamp> stamps;
  for (std::size_t i = 0; i < gone_m.size(); ++i)
    stamps.push_back(stamp_from_seconds(kScan_s * static_cast<double>(i)));
  return stamps;
}

}  // namespace

bool is_victoria_park_graph(const fs::path& file) {
  if (file.extension() != ".txt") return false;
  auto lines = TextLines::open(file);
  if (!lines || !lines->next()) return false;
  std::string_view rest = lines->line();
  return take_word(rest) == kOdometryLine.kind;
}

Result<std::unique_ptr<Source>> open_victoria_park_graph(const fs::path& file) {
  auto info = vehicle_info("Victoria Park, known trees", "Victoria Park graph", "victoria-park");
  if (!info) return info.error();
  info->identities = true;
  auto graph = read_graph(file);
  if (!graph) return graph.error();
  const fs::path log_path = file.parent_path() / kVictoriaParkLog;
  auto log = fs::exists(log_path) ? read_log(log_path) : Result<Log>(Log{});
  if (!log) return log.error();
  const std::vector<Stamp> stamps = stamps_of(*graph, *log);
  std::vector<Event> events = std::move(log->truth);
  for (std::size_t i = 0; i < graph->poses.size(); ++i) {
    auto& pose = graph->poses[i];
    events.emplace_back(stamps[i], OdometryPose{pose.T_odom_robot});
    if (!pose.seen.empty()) events.emplace_back(stamps[i], std::move(pose.seen));
  }
  return std::unique_ptr<Source>(
      std::make_unique<EventList>(*std::move(info), std::move(events), std::move(log->notes)));
}

}  // namespace waymark
