#include "workbench/logs/log_writer.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include "workbench/logs/camera_yaml.hpp"
#include "workbench/logs/files.hpp"
#include "workbench/logs/image_file.hpp"
#include "workbench/logs/log_format.hpp"
#include "workbench/logs/number_text.hpp"

namespace waymark {
namespace {

namespace fs = std::filesystem;

using Files = std::map<std::string, std::string, std::less<>>;

/// `,first,second` with an empty cell for what is missing.
std::string two_cells(std::optional<double> first, std::optional<double> second) {
  std::string cells = ",";
  if (first) append_shortest(cells, *first);
  cells += ',';
  if (second) append_shortest(cells, *second);
  return cells;
}

/// The cells `,range_m,bearing_rad`.
std::string polar_cells(const Measurement& value) {
  if (const auto* m = std::get_if<RangeBearing>(&value)) return two_cells(m->range_m, m->bearing_rad);
  if (const auto* m = std::get_if<Range>(&value)) return two_cells(m->range_m, std::nullopt);
  if (const auto* m = std::get_if<Bearing>(&value)) return two_cells(std::nullopt, m->bearing_rad);
  return two_cells(std::nullopt, std::nullopt);
}

/// The cells `,u_px,v_px`.
std::string pixel_cells(const Measurement& value) {
  const auto* pixel = std::get_if<Pixel>(&value);
  return pixel != nullptr ? two_cells(pixel->u_px, pixel->v_px) : two_cells(std::nullopt, std::nullopt);
}

/// The rows of observations.csv. Which columns there are shows only at the end.
class ObservationRows {
 public:
  Result<void> add(Stamp stamp, const Observations& observations) {
    std::string begin;
    append_stamp(begin, stamp);
    if (observations.empty()) rows_.push_back({begin + ',', two_cells({}, {}), two_cells({}, {})});
    for (const auto& [id, value, covariance] : observations) {
      if (covariance)
        return Error{"the observation at " + begin +
                     " s has a covariance of its own, which a log folder cannot hold"};
      (std::holds_alternative<Pixel>(value) ? has_pixel_ : has_polar_) = true;
      rows_.push_back(
          {begin + ',' + (id ? to_string(*id) : std::string()), polar_cells(value), pixel_cells(value)});
    }
    return {};
  }

  [[nodiscard]] bool empty() const { return rows_.empty(); }

  [[nodiscard]] std::string text() const {
    const bool show_polar = has_polar_ || !has_pixel_;
    std::string text = "stamp_s,id";
    if (show_polar) text += ",range_m,bearing_rad";
    if (has_pixel_) text += ",u_px,v_px";
    text += '\n';
    for (const auto& row : rows_) {
      text += row.begin;
      if (show_polar) text += row.polar;
      if (has_pixel_) text += row.pixel;
      text += '\n';
    }
    return text;
  }

 private:
  struct Row {
    std::string begin;
    std::string polar;
    std::string pixel;
  };

  std::vector<Row> rows_;
  bool has_polar_ = false;
  bool has_pixel_ = false;
};

/// The content of the files of a log folder as it grows.
class LogText {
 public:
  explicit LogText(const fs::path& folder)
      : images_(fs::absolute(folder / log_format::kImageFolder).lexically_normal()) {}

  Result<void> add(const Event& event) {
    return std::visit([&](const auto& content) { return add_content(event.stamp, content); }, event.content);
  }

  void add_landmarks(const std::vector<TrueLandmark>& landmarks) {
    for (const auto& landmark : landmarks) {
      std::string& text = file(log_format::kLandmarks);
      append_integer(text, landmark.id.number);
      finish_row(text, {landmark.x_m, landmark.y_m, landmark.z_m});
    }
  }

  /// The content of each file by its name.
  [[nodiscard]] Files finish() && {
    if (!observations_.empty()) files_.emplace(log_format::kObservations.file, observations_.text());
    return std::move(files_);
  }

 private:
  /// The text of a file, begun with its header.
  std::string& file(const log_format::Table& table) {
    std::string& text = files_[std::string(table.file)];
    if (text.empty()) text.append(table.columns) += '\n';
    return text;
  }

  static void finish_row(std::string& text, std::initializer_list<double> numbers) {
    for (const double number : numbers) append_shortest(text += ',', number);
    text += '\n';
  }

  Result<void> add_row(const log_format::Table& table, Stamp stamp, std::initializer_list<double> numbers) {
    std::string& text = file(table);
    append_stamp(text, stamp);
    finish_row(text, numbers);
    return {};
  }

  Result<void> add_content(Stamp stamp, const WheelAngles& wheels) {
    return add_row(log_format::kWheels, stamp, {wheels.left_rad, wheels.right_rad});
  }
  Result<void> add_content(Stamp stamp, const Velocity& velocity) {
    return add_row(log_format::kVelocity, stamp, {velocity.v_mps, velocity.w_radps});
  }
  Result<void> add_content(Stamp stamp, const Steering& steering) {
    return add_row(log_format::kSteering, stamp, {steering.v_mps, steering.steer_rad});
  }
  Result<void> add_content(Stamp stamp, const OdometryPose& odometry) {
    const Pose2& pose = odometry.T_odom_robot;
    return add_row(log_format::kOdometry, stamp, {pose.x_m, pose.y_m, pose.theta_rad});
  }
  Result<void> add_content(Stamp stamp, const YawRate& rate) {
    return add_row(log_format::kYawRate, stamp, {rate.w_radps});
  }
  Result<void> add_content(Stamp stamp, const Truth& truth) {
    if (truth.theta_rad) return add_row(log_format::kTruth, stamp, {truth.x_m, truth.y_m, *truth.theta_rad});
    std::string& text = file(log_format::kTruth);
    append_stamp(text, stamp);
    append_shortest(text += ',', truth.x_m);
    append_shortest(text += ',', truth.y_m);
    text += ",\n";
    return {};
  }

  Result<void> add_content(Stamp /*stamp*/, const MarkerOutlines& /*outlines*/) {
    return Error{"a log folder cannot store the corners of markers"};
  }

  Result<void> add_content(Stamp stamp, const Image& image) {
    if (image.file.empty() && image.pixels != nullptr) return add_pixels(stamp, *image.pixels);
    return add_image_file(stamp, image);
  }

  Result<void> add_pixels(Stamp stamp, const GreyImage& pixels) {
    const std::string name = fmt::format("{:06}.png", images_written_++);
    if (auto made = ensure_output_folder(images_); !made) return made;
    if (auto written = write_png(images_ / name, pixels); !written) return written;
    add_image_row(stamp, name);
    return {};
  }

  /// An image that lies elsewhere is named by its full path.
  Result<void> add_image_file(Stamp stamp, const Image& image) {
    if (image.file.find_first_of(",\n") != std::string::npos)
      return Error{image.file + ": an image name in a log must not contain a comma"};
    const fs::path full = fs::absolute(image.file).lexically_normal();
    const fs::path relative = full.lexically_relative(images_);
    const bool is_inside = !relative.empty() && *relative.begin() != "..";
    add_image_row(stamp, (is_inside ? relative : full).string());
    return {};
  }

  void add_image_row(Stamp stamp, const std::string& name) {
    std::string& text = file(log_format::kImages);
    append_stamp(text, stamp);
    text += ',' + name + '\n';
  }

  Result<void> add_content(Stamp stamp, const Observations& observations) {
    return observations_.add(stamp, observations);
  }

  fs::path images_;
  int images_written_ = 0;
  Files files_;
  ObservationRows observations_;
};

/// The last value of each key.
std::map<std::string, std::string> settings_in_force(const LogInfo& info) {
  std::map<std::string, std::string> settings;
  for (const auto& [key, value] : info.settings) settings[key] = value;
  return settings;
}

using Sections = std::map<std::string, std::map<std::string, std::string>>;

Sections sections_of(std::map<std::string, std::string> settings) {
  Sections sections;
  for (const auto& [log_key, config_key] : log_format::kSettings) {
    const auto setting = settings.find(std::string(config_key));
    if (setting == settings.end()) continue;
    const std::size_t dot = log_key.find('.');
    sections[std::string(log_key.substr(0, dot))][std::string(log_key.substr(dot + 1))] = setting->second;
    settings.erase(setting);
  }
  if (!settings.empty()) sections["config"] = std::move(settings);
  return sections;
}

std::string info_yaml(const LogInfo& info, Sections sections) {
  if (info.truth_sensor_m)
    for (const auto& [axis, key] : {std::pair{0, "x_m"}, {1, "y_m"}})
      append_shortest(sections["truth_sensor"][key], (*info.truth_sensor_m)[axis]);
  YAML::Emitter yaml;
  yaml << YAML::BeginMap << YAML::Key << std::string(log_format::kVersionKey) << YAML::Value
       << std::string(log_format::kVersion) << YAML::Key << "name" << YAML::Value << info.name;
  for (const auto& [name, section] : sections) yaml << YAML::Key << name << YAML::Value << section;
  yaml << YAML::EndMap;
  return std::string(yaml.c_str()) + '\n';
}

/// What is known of the camera goes into camera.yaml, the rest into log.yaml.
void add_info(const LogInfo& info, Files& files) {
  auto settings = settings_in_force(info);
  if (const auto camera = take_lens(settings))
    files[std::string(log_format::kCameraFile)] = to_camera_yaml(*camera, "camera");
  files[std::string(log_format::kInfoFile)] = info_yaml(info, sections_of(std::move(settings)));
}

/// A file that a log may have but this one has not would be read as a part of it.
Result<void> check_no_other_log(const Files& files, const fs::path& folder) {
  std::vector<std::string_view> names{log_format::kCameraFile};
  for (const auto& table : log_format::kTables) names.push_back(table.file);
  for (const std::string_view name : names)
    if (!files.contains(name) && fs::exists(folder / name))
      return Error{fmt::format("{} is of another log; remove it or write into another folder",
                               (folder / name).string())};
  return {};
}

Result<Files> read_all(Source& source, const fs::path& folder, const std::function<void(double)>& progress) {
  LogText text(folder);
  text.add_landmarks(source.info().landmarks);
  while (true) {
    const auto event = source.next();
    if (!event) return event.error();
    if (!*event) break;
    if (auto done = text.add(**event); !done) return done.error();
    if (progress) progress(source.progress());
  }
  Files files = std::move(text).finish();
  add_info(source.info(), files);
  return files;
}

}  // namespace

Result<void> write_log(Source& source, const fs::path& folder, const std::function<void(double)>& progress) {
  const auto files = read_all(source, folder, progress);
  if (!files) return files.error();
  if (auto done = ensure_output_folder(folder); !done) return done;
  if (auto done = check_no_other_log(*files, folder); !done) return done;
  for (const auto& [name, content] : *files)
    if (auto done = write_file(folder / name, content); !done) return done;
  return {};
}

}  // namespace waymark
