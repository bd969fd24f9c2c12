#include "workbench/datasets/landmark_graph.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <fmt/format.h>

#include "waymark/core/angle.hpp"

#include "workbench/logs/event_list.hpp"
#include "workbench/logs/files.hpp"
#include "workbench/logs/text_lines.hpp"

namespace waymark {
namespace {

namespace fs = std::filesystem;

/// What a line of a graph is of.
enum class Part { kPose, kPlace, kOdometry, kPoint, kBearing, kRange };

/// One kind of line: its word, the vertices that it names and the numbers behind them.
struct LineKind {
  std::string_view word;
  Part part;
  std::size_t names;
  std::size_t numbers;
  bool in_space = false;
};

constexpr std::array kKinds{
    LineKind{"VERTEX_SE2", Part::kPose, 1, 3},
    LineKind{"VERTEX_SE3:QUAT", Part::kPose, 1, 7, true},
    LineKind{"VERTEX_XY", Part::kPlace, 1, 2},
    LineKind{"VERTEX_XYZ", Part::kPlace, 1, 3, true},
    LineKind{"EDGE_SE2", Part::kOdometry, 2, 3 + 6},
    LineKind{"EDGE_SE3:QUAT", Part::kOdometry, 2, 7 + 21, true},
    LineKind{"EDGE_SE2_XY", Part::kPoint, 2, 2 + 3},
    LineKind{"EDGE_SE3_XYZ", Part::kPoint, 2, 3 + 6, true},
    LineKind{"EDGE_BEARING_SE2_XY", Part::kBearing, 2, 1 + 1},
    LineKind{"EDGE_RANGE", Part::kRange, 2, 1 + 1},
};

/// A line of a kind that is known.
struct GraphLine {
  const LineKind* kind = nullptr;
  int number = 0;
  std::optional<Stamp> stamp;
  std::vector<std::string> names;
  std::vector<double> values;
};

/// The letters and the number of a name: "A12" is of robot A; "12" of none.
struct Name {
  std::string letters;
  std::uint64_t number = 0;
  bool operator<(const Name& other) const {
    return std::tie(letters, number) < std::tie(other.letters, other.number);
  }
};

std::string text_of(const Name& name) { return name.letters + std::to_string(name.number); }

/// GTSAM writes a letter and a number as one number, with the letter in the upper of 8 bytes.
std::optional<Name> parse_name(std::string_view text) {
  constexpr int kLetterBits = 56;
  const std::size_t letters = std::min(text.find_first_of("0123456789"), text.size());
  const auto is_letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; };
  Name name{std::string(text.substr(0, letters)), 0};
  if (!std::ranges::all_of(name.letters, is_letter)) return std::nullopt;
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data() + letters, end, name.number);
  if (error != std::errc{} || stop != end) return std::nullopt;
  const std::uint64_t letter = name.number >> kLetterBits;
  if (letter == 0) return name;
  return Name{std::string(1, static_cast<char>(letter)),
              name.number & ((std::uint64_t{1} << kLetterBits) - 1)};
}

const LineKind* kind_named(std::string_view word) {
  const auto found = std::ranges::find(kKinds, word, &LineKind::word);
  return found == kKinds.end() ? nullptr : &*found;
}

/// A graph as it stands in the file.
struct GraphText {
  std::string name;
  std::vector<GraphLine> lines;
  std::map<std::string, std::int64_t> unknown;  ///< words of lines that are not read, with their number

  /// Vertices have letters in their names: PyFactorGraph's files, whose noise is a covariance and whose
  /// vertices are true. Else g2o's, with information matrices.
  [[nodiscard]] bool is_pyfg() const {
    return std::ranges::any_of(
        lines, [](const GraphLine& line) { return line.names.front().find_first_of("0123456789") > 0; });
  }
};

Result<GraphLine> read_known_line(const TextLines& lines, const LineKind& kind, std::string_view rest) {
  std::vector<std::string_view> words;
  for (auto word = take_word(rest); !word.empty(); word = take_word(rest)) words.push_back(word);
  GraphLine line{&kind, lines.number(), {}, {}, {}};
  const std::size_t expected = kind.names + kind.numbers;
  const bool is_stamped = words.size() == expected + 1;
  if (words.size() != expected && !is_stamped)
    return lines.error(fmt::format("expected {} vertices and {} numbers after {}, found {} words", kind.names,
                                   kind.numbers, kind.word, words.size()));
  if (is_stamped) {
    line.stamp = parse_stamp(words.front());
    if (!line.stamp) return lines.error(in_quotes(words.front()) + " is not a number of seconds");
    words.erase(words.begin());
  }
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (i < kind.names) {
      if (!parse_name(words[i])) return lines.error(in_quotes(words[i]) + " is not the name of a vertex");
      line.names.emplace_back(words[i]);
      continue;
    }
    const auto value = parse_number(words[i]);
    if (!value || !std::isfinite(*value)) return lines.error(in_quotes(words[i]) + " is not a finite number");
    line.values.push_back(*value);
  }
  return line;
}

Result<GraphText> read_graph_text(const fs::path& file) {
  auto lines = TextLines::open(file);
  if (!lines) return lines.error();
  GraphText graph{.name = file.string(), .lines = {}, .unknown = {}};
  while (lines->next()) {
    std::string_view rest = lines->line();
    const std::string_view word = take_word(rest);
    const LineKind* kind = kind_named(word);
    if (kind == nullptr) {
      ++graph.unknown[std::string(word.substr(0, 40))];
      continue;
    }
    auto line = read_known_line(*lines, *kind, rest);
    if (!line) return line.error();
    graph.lines.push_back(*std::move(line));
  }
  return graph;
}

/// A motion in space with what of it a plane has.
Eigen::Isometry3d motion_in_space(const GraphLine& line) {
  const auto& v = line.values;
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.translation() = Eigen::Vector3d(v[0], v[1], line.kind->in_space ? v[2] : 0.0);
  if (line.kind->in_space)
    T.linear() = Eigen::Quaterniond(v[6], v[3], v[4], v[5]).normalized().toRotationMatrix();
  else
    T.linear() = Eigen::AngleAxisd(v[2], Eigen::Vector3d::UnitZ()).toRotationMatrix();
  return T;
}

Pose2 on_floor(const Eigen::Isometry3d& T) {
  return {T.translation().x(), T.translation().y(), std::atan2(T.linear()(1, 0), T.linear()(0, 0))};
}

/// The noise of a line in the plane, of x, y and where `n` is 3 the yaw. Its matrix of `size` begins at
/// `first`.
template <int n>
std::optional<Eigen::Matrix<double, n, n>> noise_of(const GraphLine& line, std::size_t first,
                                                    Eigen::Index size, bool is_information) {
  Eigen::MatrixXd M(size, size);
  for (Eigen::Index i = 0; i < size; ++i)
    for (Eigen::Index j = i; j < size; ++j) M(i, j) = M(j, i) = line.values[first++];
  const Eigen::LLT<Eigen::MatrixXd> factor(M);
  if (factor.info() != Eigen::Success) return std::nullopt;
  if (is_information) M = factor.solve(Eigen::MatrixXd::Identity(M.rows(), M.cols())).eval();
  Eigen::Matrix<double, n, n> P = M.topLeftCorner<n, n>();
  if constexpr (n == 3) {
    const Eigen::Index turn = M.rows() - 1;  // the yaw is last, in SE(2) and in SE(3)
    P.template rightCols<1>() << M(0, turn), M(1, turn), M(turn, turn);
    P.template bottomRows<1>() = P.template rightCols<1>().transpose();
  }
  return P;
}

/// The graph as a log: poses in order, what was seen from each, and what is true where it is stated.
struct LandmarkGraph {
  struct Step {
    Eigen::Isometry3d moved;
    std::optional<Eigen::Matrix3d> covariance;
  };
  struct Seen {
    std::size_t pose;
    Name landmark;
    const GraphLine* line;
  };

  std::vector<Name> poses;            ///< in order
  std::map<Name, std::size_t> index;  ///< of each
  std::vector<Stamp> stamps;
  std::vector<std::optional<Step>> steps;  ///< to each pose from the one before
  std::map<Name, Eigen::Isometry3d> true_poses;
  std::map<Name, Eigen::Vector3d> places;
  std::vector<Seen> seen;
  std::int64_t loops = 0;
  std::set<Name> other_robots;  ///< poses of robots that are not followed
};

/// Poses of the first robot by number; stamps count where they grow from one to the next.
void order_poses(const GraphText& text, LandmarkGraph& graph) {
  std::map<Name, std::optional<Stamp>> found;
  for (const GraphLine& line : text.lines) {
    if (line.kind->part == Part::kPose) found.emplace(*parse_name(line.names[0]), line.stamp);
    if (line.kind->part != Part::kOdometry) continue;
    for (const std::string& name : line.names) found.emplace(*parse_name(name), std::nullopt);
  }
  if (found.empty()) return;
  const std::string robot = found.begin()->first.letters;
  for (const auto& [name, stamp] : found)
    if (name.letters == robot)
      graph.poses.push_back(name);
    else
      graph.other_robots.insert(name);
  bool stamped = true;
  for (std::size_t i = 0; i < graph.poses.size(); ++i) {
    graph.index[graph.poses[i]] = i;
    const auto stamp = found[graph.poses[i]];
    stamped = stamped && stamp && (i == 0 || *stamp > graph.stamps.back());
    graph.stamps.push_back(stamp.value_or(Stamp{}));
  }
  if (stamped) return;
  for (std::size_t i = 0; i < graph.stamps.size(); ++i) graph.stamps[i] = Stamp{std::chrono::seconds(i)};
}

std::optional<std::size_t> index_of(const LandmarkGraph& graph, const std::string& name) {
  const auto found = graph.index.find(*parse_name(name));
  return found == graph.index.end() ? std::nullopt : std::optional(found->second);
}

void add_graph_odometry(const GraphLine& line, bool is_information, LandmarkGraph& graph) {
  const auto from = index_of(graph, line.names[0]), to = index_of(graph, line.names[1]);
  if (!from || !to) return;
  const bool follows = *to == *from + 1, precedes = *from == *to + 1;
  const bool in_space = line.kind->in_space;
  auto& step = graph.steps[std::max(*from, *to)];
  if ((!follows && !precedes) || step) {
    ++graph.loops;
    return;
  }
  const Eigen::Isometry3d moved = motion_in_space(line);
  const auto covariance = noise_of<3>(line, in_space ? 7 : 3, in_space ? 6 : 3, is_information);
  step = LandmarkGraph::Step{follows ? moved : moved.inverse(), covariance};
}

LandmarkGraph build_graph(const GraphText& text) {
  LandmarkGraph graph;
  order_poses(text, graph);
  graph.steps.resize(graph.poses.size());
  const bool is_information = !text.is_pyfg();
  for (const GraphLine& line : text.lines) {
    const Name name = *parse_name(line.names.back());
    switch (line.kind->part) {
      case Part::kPose:
        graph.true_poses.emplace(name, motion_in_space(line));
        break;
      case Part::kPlace:
        graph.places.emplace(name, Eigen::Vector3d(line.values[0], line.values[1],
                                                   line.kind->in_space ? line.values[2] : 0.0));
        break;
      case Part::kOdometry:
        add_graph_odometry(line, is_information, graph);
        break;
      default:
        if (const auto pose = index_of(graph, line.names[0]);
            pose && !graph.index.contains(name) && !graph.other_robots.contains(name))
          graph.seen.push_back({*pose, name, &line});
    }
  }
  return graph;
}

/// Poses of dead reckoning, in the plane.
Result<std::vector<Pose2>> dead_reckoned(const GraphText& text, const LandmarkGraph& graph) {
  constexpr double kHeightShare = 0.01;
  const double max_tilt_rad = to_radians(5.0);
  std::vector<Pose2> poses{Pose2{}};
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  double length_m = 0.0, low_m = 0.0, high_m = 0.0, tilt_rad = 0.0;
  for (std::size_t i = 1; i < graph.poses.size(); ++i) {
    if (!graph.steps[i])
      return Error{fmt::format("{}: no edge leads from pose {} to {}: a gap in the odometry", text.name,
                               text_of(graph.poses[i - 1]), text_of(graph.poses[i]))};
    T = T * graph.steps[i]->moved;
    length_m += graph.steps[i]->moved.translation().norm();
    low_m = std::min(low_m, T.translation().z());
    high_m = std::max(high_m, T.translation().z());
    tilt_rad = std::max(tilt_rad, std::acos(std::clamp(T.linear()(2, 2), -1.0, 1.0)));
    poses.push_back(on_floor(T));
  }
  if (high_m - low_m <= kHeightShare * length_m && tilt_rad <= max_tilt_rad) return poses;
  return Error{
      fmt::format("{}: its poses leave the plane, z spreads over {:.3g} m and they tilt by up to {:.3g} "
                  "deg; Waymark estimates planar paths",
                  text.name, high_m - low_m, to_degrees(tilt_rad))};
}

/// The quarter turn from the axis of the poses along which they move to x; poses that move backwards stay.
double forward_axis_rad(const std::vector<Pose2>& poses) {
  Eigen::Vector2d along = Eigen::Vector2d::Zero();
  for (std::size_t i = 1; i < poses.size(); ++i) along += (poses[i - 1].inverse() * poses[i]).position();
  if (std::abs(along.y()) <= std::abs(along.x())) return 0.0;
  return std::copysign(0.5 * kPi, along.y());
}

/// A point seen from a pose as range and bearing, with its noise.
std::optional<Observation> polar(const GraphLine& line, bool is_information, double turn_rad) {
  const Eigen::Matrix2d R = rotation_matrix(-turn_rad);
  const Eigen::Vector2d p = R * Eigen::Vector2d(line.values[0], line.values[1]);
  const double r = p.norm();
  if (r == 0.0) return std::nullopt;
  Observation observation{std::nullopt, RangeBearing{r, std::atan2(p.y(), p.x())}, std::nullopt};
  const int size = line.kind->in_space ? 3 : 2;
  if (const auto P = noise_of<2>(line, static_cast<std::size_t>(size), size, is_information)) {
    Eigen::Matrix2d J;
    J << p.x() / r, p.y() / r, -p.y() / (r * r), p.x() / (r * r);
    observation.covariance = J * R * *P * R.transpose() * J.transpose();
  }
  return observation;
}

std::optional<Observation> graph_observation(const GraphLine& line, bool is_information, double turn_rad) {
  if (line.kind->part == Part::kPoint) return polar(line, is_information, turn_rad);
  const double noise = is_information ? 1.0 / line.values[1] : line.values[1];
  Observation observation;
  if (line.kind->part == Part::kRange) {
    if (line.values[0] < 0.0) return std::nullopt;
    observation.value = Range{line.values[0]};
  } else {
    observation.value = Bearing{wrap_angle(line.values[0] - turn_rad)};
  }
  if (std::isfinite(noise) && noise > 0.0)
    observation.covariance = Eigen::Matrix2d(Eigen::Vector2d(noise, 0.0).asDiagonal());
  return observation;
}

/// Landmarks by number; where two have the same one, or one is beyond 32 bits, all are counted anew.
std::map<Name, LandmarkId> ids_of(const LandmarkGraph& graph) {
  std::map<Name, LandmarkId> ids;
  std::map<std::uint64_t, int> uses;
  for (const auto& seen : graph.seen)
    if (ids.try_emplace(seen.landmark).second) ++uses[seen.landmark.number];
  const bool unique = std::ranges::all_of(uses, [](const auto& use) {
    return use.second == 1 && use.first <= std::uint64_t{std::numeric_limits<std::int32_t>::max()};
  });
  std::int32_t count = 0;
  for (auto& [name, id] : ids)
    id = {LandmarkId::Family::kMarker, unique ? static_cast<std::int32_t>(name.number) : count++};
  return ids;
}

/// What one robot's odometry does per metre, where all steps state it: a setting if it is in its range.
void add_graph_noise(const LandmarkGraph& graph, double turn_rad, LogInfo& info) {
  Eigen::Vector3d variances = Eigen::Vector3d::Zero();
  double length_m = 0.0;
  Eigen::Matrix3d G = Eigen::Matrix3d::Identity();
  G.topLeftCorner<2, 2>() = rotation_matrix(-turn_rad);
  for (std::size_t i = 1; i < graph.steps.size(); ++i) {
    if (!graph.steps[i]->covariance) return;
    variances += (G * *graph.steps[i]->covariance * G.transpose()).diagonal();
    length_m += graph.steps[i]->moved.translation().norm();
  }
  if (length_m <= 0.0) return;
  constexpr std::array kKeys{"motion.forward_var_m2_per_m", "motion.lateral_var_m2_per_m",
                             "motion.turn_var_rad2_per_m"};
  for (std::size_t i = 0; i < kKeys.size(); ++i)
    if (const double each = variances[static_cast<Eigen::Index>(i)] / length_m; each <= 1.0)
      info.settings.emplace_back(kKeys[i], fmt::format("{:.4g}", each));
}

std::vector<std::string> notes_of_graph(const GraphText& text, const LandmarkGraph& graph, double turn_rad) {
  std::vector<std::string> notes;
  notes.emplace_back(text.is_pyfg()
                         ? "the graph's vertices are taken as ground truth, as PyFactorGraph writes it"
                         : "the graph's vertices are a first guess and no ground truth: not used");
  if (graph.stamps.front() == Stamp{} &&
      graph.stamps.back() == Stamp{std::chrono::seconds(graph.stamps.size() - 1)})
    notes.emplace_back("poses have no stamps: they are taken as 1 s apart");
  if (turn_rad != 0.0)
    notes.push_back(fmt::format("the poses move along their {}y axis, which is taken as the robot's x axis",
                                turn_rad > 0.0 ? "" : "-"));
  if (graph.loops > 0)
    notes.push_back(
        fmt::format("{} edges between poses that do not follow one another are not used", graph.loops));
  if (!graph.other_robots.empty())
    notes.push_back(fmt::format("{} poses of other robots than {} are not used", graph.other_robots.size(),
                                graph.poses.front().letters));
  for (const auto& [word, count] : text.unknown)
    notes.push_back(fmt::format("{} lines {} are not used", count, word));
  return notes;
}

Error no_landmarks(const GraphText& text) {
  return {
      fmt::format("{}: is a pose graph without observations of landmarks; a log needs EDGE_SE2_XY, "
                  "EDGE_SE3_XYZ, EDGE_BEARING_SE2_XY or EDGE_RANGE",
                  text.name)};
}

/// What was seen from each pose.
std::vector<Observations> scans_of(const LandmarkGraph& graph, bool is_information, double turn_rad) {
  std::vector<Observations> scans(graph.poses.size());
  const auto ids = ids_of(graph);
  for (const auto& [pose, landmark, line] : graph.seen) {
    auto observation = graph_observation(*line, is_information, turn_rad);
    if (!observation) continue;
    observation->id = ids.at(landmark);
    scans[pose].push_back(*std::move(observation));
  }
  return scans;
}

void add_graph_truth(const LandmarkGraph& graph, const Pose2& T_pose_robot, std::vector<Event>& events,
                     LogInfo& info) {
  for (std::size_t i = 0; i < graph.poses.size(); ++i) {
    const auto found = graph.true_poses.find(graph.poses[i]);
    if (found == graph.true_poses.end()) continue;
    const Pose2 pose = on_floor(found->second) * T_pose_robot;
    events.emplace_back(graph.stamps[i], Truth{pose.x_m, pose.y_m, pose.theta_rad});
  }
  for (const auto& [name, id] : ids_of(graph))
    if (const auto place = graph.places.find(name); place != graph.places.end())
      info.landmarks.push_back({id, place->second.x(), place->second.y(), place->second.z()});
}

/// Enough for comments and the first line; any file may be asked, large ones too.
std::string beginning_of(const fs::path& file) {
  std::string text(4096, '\0');
  if (!check_is_file(file)) return "";
  std::ifstream stream(file, std::ios::binary);
  stream.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(stream.gcount()));
  return text;
}

}  // namespace

bool is_landmark_graph(const fs::path& file) {
  constexpr std::array kMore{"FIX", "PARAMS_SE2OFFSET", "PARAMS_SE3OFFSET"};
  TextLines lines(beginning_of(file), file.string());
  if (!lines.next()) return false;
  std::string_view rest = lines.line();
  const std::string_view word = take_word(rest);
  return word.starts_with("VERTEX_") || word.starts_with("EDGE_") ||
         std::ranges::find(kMore, word) != kMore.end();
}

Result<std::unique_ptr<Source>> open_landmark_graph(const fs::path& file) {
  const auto text = read_graph_text(file);
  if (!text) return text.error();
  const LandmarkGraph graph = build_graph(*text);
  if (graph.seen.empty()) return no_landmarks(*text);
  const auto poses = dead_reckoned(*text, graph);
  if (!poses) return poses.error();
  const double turn_rad = forward_axis_rad(*poses);
  const Pose2 T_pose_robot{0.0, 0.0, turn_rad};
  LogInfo info{.name = base_name(file),
               .format = text->is_pyfg() ? "landmark graph of PyFactorGraph" : "landmark graph of g2o",
               .settings = {},
               .landmarks = {}};
  auto scans = scans_of(graph, !text->is_pyfg(), turn_rad);
  add_graph_noise(graph, turn_rad, info);
  std::vector<Event> events;
  for (std::size_t i = 0; i < poses->size(); ++i) {
    events.emplace_back(graph.stamps[i], OdometryPose{T_pose_robot.inverse() * (*poses)[i] * T_pose_robot});
    if (!scans[i].empty()) events.emplace_back(graph.stamps[i], std::move(scans[i]));
  }
  if (text->is_pyfg()) add_graph_truth(graph, T_pose_robot, events, info);
  return std::unique_ptr<Source>(std::make_unique<EventList>(std::move(info), std::move(events),
                                                             notes_of_graph(*text, graph, turn_rad)));
}

}  // namespace waymark
