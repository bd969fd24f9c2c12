#include "workbench/datasets/planar_mono_slam.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <Eigen/LU>
#include <fmt/format.h>

#include "waymark/core/angle.hpp"
#include "waymark/core/random.hpp"
#include "waymark/models/camera.hpp"

#include "workbench/config/known_settings.hpp"
#include "workbench/config/robot_keys.hpp"
#include "workbench/logs/event_list.hpp"
#include "workbench/logs/files.hpp"
#include "workbench/logs/number_text.hpp"
#include "workbench/logs/text_table.hpp"

namespace waymark {
namespace {

namespace fs = std::filesystem;

constexpr const char* kCameraFile = "camera.dat";
constexpr const char* kTrajectoryFile = "trajectory.dat";
constexpr const char* kWorldFile = "world.dat";
constexpr auto kByBlanks = TableLayout::Separator::kBlank;
constexpr int kLastStep = 1'000'000;
constexpr Duration kStep = std::chrono::milliseconds(200);
/// What the recorded points are off by rounding, at most, px; less is claimed of no pixel.
constexpr double kRounding_px = 0.1;

Stamp stamp_of(int step) { return Stamp{} + step * kStep; }

LandmarkId marker_id(int number) { return {LandmarkId::Family::kMarker, number}; }

/// All that is left of a line.
Result<std::vector<double>> read_numbers(const TextLines& lines, std::string_view rest, std::size_t count,
                                         std::string_view meaning) {
  std::vector<double> numbers;
  for (auto word = take_word(rest); !word.empty(); word = take_word(rest)) {
    const auto number = parse_number(word);
    if (!number || !std::isfinite(*number)) return lines.error(in_quotes(word) + " is not a finite number");
    numbers.push_back(*number);
  }
  if (numbers.size() == count) return numbers;
  return lines.error(fmt::format("expected {}, found {} numbers", meaning, numbers.size()));
}

/// The next line, which must begin with `key`; what stands behind that.
Result<std::string_view> read_key(TextLines& lines, std::string_view key) {
  const bool found = lines.next() && lines.line().starts_with(key);
  if (!found) return lines.error(fmt::format("expected a line `{}`", key));
  return lines.line().substr(key.size());
}

Result<double> read_value(TextLines& lines, std::string_view key) {
  const auto rest = read_key(lines, key);
  if (!rest) return rest.error();
  const auto numbers = read_numbers(lines, *rest, 1, "one number");
  if (!numbers) return numbers.error();
  return numbers->front();
}

template <int kSide>
Result<Eigen::Matrix<double, kSide, kSide>> read_matrix(TextLines& lines, std::string_view heading) {
  if (const auto rest = read_key(lines, heading); !rest) return rest.error();
  Eigen::Matrix<double, kSide, kSide> matrix;
  for (int row = 0; row < kSide; ++row) {
    const std::string_view line = lines.next() ? lines.line() : std::string_view{};
    const auto numbers =
        read_numbers(lines, line, kSide, fmt::format("a row of {} numbers under `{}`", kSide, heading));
    if (!numbers) return numbers.error();
    for (int column = 0; column < kSide; ++column)
      matrix(row, column) = (*numbers)[static_cast<std::size_t>(column)];
  }
  return matrix;
}

bool is_pinhole(const Eigen::Matrix3d& K) {
  return K(0, 0) > 0.0 && K(1, 1) > 0.0 && K(0, 1) == 0.0 && K(1, 0) == 0.0 &&
         K.row(2) == Eigen::RowVector3d::UnitZ();
}

bool is_rigid(const Eigen::Matrix4d& T) {
  const Eigen::Matrix3d R = T.topLeftCorner<3, 3>();
  return (R * R.transpose()).isIdentity(1e-4) && R.determinant() > 0.0 &&
         T.row(3) == Eigen::RowVector4d::UnitW();
}

/// The angles of CameraMount.
CameraMount mount_of(const Eigen::Matrix4d& T_robot_camera) {
  CameraMount mount{.x_m = T_robot_camera(0, 3), .y_m = T_robot_camera(1, 3), .z_m = T_robot_camera(2, 3)};
  const Eigen::Matrix3d R = T_robot_camera.topLeftCorner<3, 3>() * CameraMount{}.R_robot_camera().transpose();
  mount.yaw_deg = to_degrees(std::atan2(R(1, 0), R(0, 0)));
  mount.pitch_deg = to_degrees(std::atan2(-R(2, 0), std::hypot(R(2, 1), R(2, 2))));
  mount.roll_deg = to_degrees(std::atan2(R(2, 1), R(2, 2)));
  return mount;
}

using Settings = std::vector<std::pair<std::string, std::string>>;

std::string to_text(double value) {
  std::string text;
  append_shortest(text, value);
  return text;
}

Settings settings_of(CameraOptions camera, double farthest_m) {
  Schema schema;
  describe(schema, camera);
  Settings settings;
  for (const std::string& key : schema.keys()) settings.emplace_back(key, schema.value(key));
  settings.emplace_back("pixel.farthest_m", to_text(farthest_m));
  return settings;
}

Result<Settings> read_camera(const fs::path& file) {
  auto lines = TextLines::open(file);
  if (!lines) return lines.error();
  const auto K = read_matrix<3>(*lines, "camera matrix:");
  if (!K) return K.error();
  if (!is_pinhole(*K)) return lines->error("the camera matrix must be fu 0 cu, 0 fv cv, 0 0 1");
  const auto T = read_matrix<4>(*lines, "cam_transform:");
  if (!T) return T.error();
  if (!is_rigid(*T)) return lines->error("cam_transform must be a rotation and a translation: R t, 0 0 0 1");
  std::array<double, 4> values{};
  const std::array keys{"z_near:", "z_far:", "width:", "height:"};
  for (std::size_t i = 0; i < keys.size(); ++i) {
    const auto value = read_value(*lines, keys[i]);
    if (!value) return value.error();
    values[i] = *value;
    if (i > 0 && (*value <= 0.0 || *value >= 1e5))
      return lines->error(fmt::format("{} must be above 0 and below 1e5", keys[i]));
  }
  return settings_of({.width_px = static_cast<int>(values[2]),
                      .height_px = static_cast<int>(values[3]),
                      .fu_px = (*K)(0, 0),
                      .fv_px = (*K)(1, 1),
                      .cu_px = (*K)(0, 2),
                      .cv_px = (*K)(1, 2),
                      .distortion = {},
                      .mount = mount_of(*T)},
                     values[1]);
}

Result<void> read_world(const fs::path& file, LogInfo& info) {
  auto table = TextTable::open(file, {"id,x_m,y_m,z_m", kByBlanks, ""});
  if (!table) return table.error();
  while (table->next())
    info.landmarks.push_back(
        {marker_id(table->integer(0)), table->number(1), table->number(2), table->number(3)});
  if (table->error()) return *table->error();
  return {};
}

/// "INDEX WORLD_ID COL ROW"
Result<Observation> read_point(const TextLines& lines, std::string_view rest) {
  const auto numbers = read_numbers(lines, rest, 4, "point INDEX WORLD_ID COL ROW");
  if (!numbers) return numbers.error();
  const double id = (*numbers)[1];
  if (id < 0.0 || id > 1e9 || id != std::floor(id))
    return lines.error("WORLD_ID must be a whole number from 0 on");
  const Pixel pixel{(*numbers)[2], (*numbers)[3]};
  return Observation{marker_id(static_cast<int>(id)), pixel, std::nullopt};
}

Result<Observations> read_points(const fs::path& file, int step) {
  auto lines = TextLines::open(file);
  if (!lines) return lines.error();
  const auto number = read_value(*lines, "seq:");
  if (!number) return number.error();
  if (*number != step) return lines->error(fmt::format("belongs to step {}, not {}", *number, step));
  for (const char* pose : {"gt_pose:", "odom_pose:"}) {
    const auto rest = read_key(*lines, pose);
    if (!rest) return rest.error();
    if (auto numbers = read_numbers(*lines, *rest, 3, "x, y and theta"); !numbers) return numbers.error();
  }
  Observations points;
  while (lines->next()) {
    std::string_view rest = lines->line();
    if (take_word(rest) != "point") return lines->error("expected point INDEX WORLD_ID COL ROW");
    const auto point = read_point(*lines, rest);
    if (!point) return point.error();
    points.push_back(*point);
  }
  return points;
}

void add_noise(const PixelNoise& noise, int step, Observations& points) {
  RandomStream random(noise.seed, StreamPurpose::kSimulation, static_cast<std::uint64_t>(step));
  for (Observation& point : points) {
    auto& [u_px, v_px] = std::get<Pixel>(point.value);
    u_px += noise.sigma_px * random.normal();
    v_px += noise.sigma_px * random.normal();
  }
}

Pose2 read_pose(TextTable& row, std::size_t column) {
  return {row.number(column), row.number(column + 1), row.number(column + 2)};
}

/// The number of the step, which must be above that of the row before.
int read_step(TextTable& row, int last) {
  const int step = row.integer(0);
  if (step <= last || step > kLastStep)
    row.fail(fmt::format("step {} must be above {}, that of the row before, and at most {}", step, last,
                         kLastStep));
  return step;
}

Result<std::vector<Event>> read_steps(const fs::path& folder, const PixelNoise& noise) {
  auto row = TextTable::open(folder / kTrajectoryFile,
                             {"step,odometry_x,odometry_y,odometry_theta,x,y,theta", kByBlanks, ""});
  if (!row) return row.error();
  std::vector<Event> events;
  for (int step = -1; row->next();) {
    step = read_step(*row, step);
    const Pose2 T_odom_robot = read_pose(*row, 1);
    const Pose2 truth = read_pose(*row, 4);
    const fs::path file = folder / fmt::format("meas-{:05}.dat", step);
    if (!fs::exists(file)) row->fail(file.filename().string() + " of this step is missing");
    if (row->error()) break;
    auto points = read_points(file, step);
    if (!points) return points.error();
    add_noise(noise, step, *points);
    const Stamp stamp = stamp_of(step);
    events.emplace_back(stamp, OdometryPose{T_odom_robot});
    events.emplace_back(stamp, Truth{truth.x_m, truth.y_m, wrap_angle(truth.theta_rad)});
    events.emplace_back(stamp, *std::move(points));
  }
  if (row->error()) return *row->error();
  return events;
}

Result<LogInfo> read_info(const fs::path& folder, const PixelNoise& noise) {
  LogInfo info;
  info.name = base_name(folder);
  info.format = "planar mono SLAM";
  info.only_pixels = true;
  auto settings = known_settings("planar-mono-slam");
  if (!settings) return settings.error();
  info.settings = *std::move(settings);
  auto camera = read_camera(folder / kCameraFile);
  if (!camera) return camera.error();
  info.settings.insert(info.settings.end(), camera->begin(), camera->end());
  info.settings.emplace_back("pixel.sigma_px", to_text(std::max(noise.sigma_px, kRounding_px)));
  if (auto done = read_world(folder / kWorldFile, info); !done) return done.error();
  return info;
}

}  // namespace

bool is_planar_mono_slam(const fs::path& folder) {
  return std::ranges::all_of(std::array{kCameraFile, kTrajectoryFile, kWorldFile},
                             [&folder](const char* file) { return fs::exists(folder / file); });
}

Result<std::unique_ptr<Source>> open_planar_mono_slam(const fs::path& folder, const PixelNoise& noise) {
  auto info = read_info(folder, noise);
  if (!info) return info.error();
  auto events = read_steps(folder, noise);
  if (!events) return events.error();
  std::vector<std::string> notes;
  if (noise.sigma_px > 0.0)
    notes.push_back(fmt::format(
        "noise of {} px was added to every point, since the recorded ones have none (input.pixel_noise_px)",
        noise.sigma_px));
  return std::unique_ptr<Source>(
      std::make_unique<EventList>(*std::move(info), *std::move(events), std::move(notes)));
}

}  // namespace waymark
