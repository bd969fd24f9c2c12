#include "workbench/logs/camera_yaml.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include "workbench/config/load_yaml.hpp"
#include "workbench/config/robot_keys.hpp"
#include "workbench/logs/files.hpp"
#include "workbench/logs/number_text.hpp"
#include "workbench/logs/text_lines.hpp"

namespace waymark {
namespace {

constexpr int kSideMax_px = 16384;
constexpr std::string_view kMountKeys = "camera.mount_";

/// The file while it is read; the first thing wrong is kept.
class Reader {
 public:
  Reader(const YAML::Node& root, const std::string& name) : root_(root), name_(name) {}

  [[nodiscard]] std::optional<Error> error() const { return error_; }

  int side_px(const char* key) {
    const YAML::Node node = find(key);
    if (!node) return 0;
    const auto value = node.IsScalar() ? parse_integer(node.Scalar()) : std::nullopt;
    if (!value || *value < 1 || *value > kSideMax_px)
      fail(node, fmt::format("{} must be a whole number from 1 to {}", key, kSideMax_px));
    return value.value_or(0);
  }

  /// The numbers under `key: {data: [...]}`; there must be one of `counts`.
  std::vector<double> matrix(const char* key, std::initializer_list<std::size_t> counts) {
    const YAML::Node node = find(key);
    const YAML::Node data = node && node.IsMap() ? node["data"] : YAML::Node(YAML::NodeType::Undefined);
    std::vector<double> values;
    if (data && data.IsSequence()) {
      for (const YAML::Node& item : data) {
        const auto value = item.IsScalar() ? parse_number(item.Scalar()) : std::nullopt;
        if (!value || !std::isfinite(*value))
          fail(item, fmt::format("{} contains something that is not a number", key));
        values.push_back(value.value_or(0.0));
      }
    }
    if (node && std::ranges::find(counts, values.size()) == counts.end())
      fail(node, fmt::format("{} needs data: [...] with {} numbers, found {}", key, *counts.begin(),
                             values.size()));
    values.resize(*counts.begin());
    return values;
  }

  void check_model() {
    const YAML::Node model = root_["distortion_model"];
    if (model && (!model.IsScalar() || (model.Scalar() != "plumb_bob" && !model.Scalar().empty())))
      fail(model, "distortion_model is not supported; only plumb_bob is");
  }

  void check_pinhole(const std::vector<double>& K) {
    const bool is_pinhole =
        K[0] > 0.0 && K[4] > 0.0 && K[1] == 0.0 && K[3] == 0.0 && K[6] == 0.0 && K[7] == 0.0 && K[8] == 1.0;
    if (!is_pinhole)
      fail(root_["camera_matrix"],
           "camera_matrix must be [fx, 0, cx, 0, fy, cy, 0, 0, 1] with fx and fy above 0");
  }

 private:
  YAML::Node find(const char* key) {
    const YAML::Node node = root_[key];
    if (!node && !error_)
      error_ = Error{fmt::format("{}: {} is missing; expected a ROS camera_info file", name_, key)};
    return node;
  }

  void fail(const YAML::Node& where, const std::string& what) {
    if (!error_) error_ = Error{fmt::format("{}:{}: {}", name_, where.Mark().line + 1, what)};
  }

  YAML::Node root_;
  const std::string& name_;
  std::optional<Error> error_;
};

Result<CameraOptions> read_camera(const YAML::Node& root, const std::string& name) {
  if (!root.IsMap()) return Error{name + ":1: expected lines of `key: value` as in a ROS camera_info file"};
  Reader reader(root, name);
  CameraOptions camera{.width_px = reader.side_px("image_width"),
                       .height_px = reader.side_px("image_height")};
  reader.check_model();
  const auto K = reader.matrix("camera_matrix", {9});
  if (!reader.error()) reader.check_pinhole(K);
  const auto D = reader.matrix("distortion_coefficients", {5, 4});
  if (reader.error()) return *reader.error();
  camera.fu_px = K[0];
  camera.cu_px = K[2];
  camera.fv_px = K[4];
  camera.cv_px = K[5];
  camera.distortion = {.k1 = D[0], .k2 = D[1], .p1 = D[2], .p2 = D[3], .k3 = D[4]};
  return camera;
}

std::string list(std::initializer_list<double> values) {
  std::string text = "[";
  for (const double value : values) append_shortest(text += text.size() > 1 ? ", " : "", value);
  return text + ']';
}

}  // namespace

std::vector<std::pair<std::string, std::string>> lens_settings(CameraOptions camera) {
  Schema schema;
  describe(schema, camera);
  std::vector<std::pair<std::string, std::string>> settings;
  for (const std::string& key : schema.keys())
    if (!key.starts_with(kMountKeys)) settings.emplace_back(key, schema.value(key));
  return settings;
}

std::optional<CameraOptions> take_lens(std::map<std::string, std::string>& settings) {
  CameraOptions camera;
  Schema schema;
  describe(schema, camera);
  const auto keys = lens_settings(camera);
  for (const auto& [key, value] : keys) {
    const auto setting = settings.find(key);
    if (setting == settings.end() || !schema.set(key, setting->second, "")) return std::nullopt;
  }
  for (const auto& [key, value] : keys) settings.erase(key);
  return camera;
}

Result<CameraOptions> parse_camera_yaml(const std::string& yaml, const std::string& name) {
  const auto root = load_yaml(yaml, name);
  return root ? read_camera(*root, name) : root.error();
}

Result<CameraOptions> read_camera_yaml(const std::filesystem::path& path) {
  const auto text = read_file(path);
  if (!text) return text.error();
  return parse_camera_yaml(*text, path.string());
}

std::string to_camera_yaml(const CameraOptions& camera, const std::string& name) {
  const auto& [k1, k2, p1, p2, k3] = camera.distortion;
  const double fu = camera.fu_px, fv = camera.fv_px, cu = camera.cu_px, cv = camera.cv_px;
  return fmt::format(
      "image_width: {}\nimage_height: {}\ncamera_name: {}\n"
      "camera_matrix:\n  rows: 3\n  cols: 3\n  data: {}\n"
      "distortion_model: plumb_bob\n"
      "distortion_coefficients:\n  rows: 1\n  cols: 5\n  data: {}\n"
      "rectification_matrix:\n  rows: 3\n  cols: 3\n  data: {}\n"
      "projection_matrix:\n  rows: 3\n  cols: 4\n  data: {}\n",
      camera.width_px, camera.height_px, name, list({fu, 0, cu, 0, fv, cv, 0, 0, 1}),
      list({k1, k2, p1, p2, k3}), list({1, 0, 0, 0, 1, 0, 0, 0, 1}),
      list({fu, 0, cu, 0, 0, fv, cv, 0, 0, 0, 1, 0}));
}

}  // namespace waymark
