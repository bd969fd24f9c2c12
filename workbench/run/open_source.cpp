#include "workbench/run/open_source.hpp"

#include <algorithm>
#include <string>
#include <system_error>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "workbench/bags/bag_source.hpp"
#include "workbench/bags/open_bag.hpp"
#include "workbench/datasets/car_park.hpp"
#include "workbench/datasets/lost_in_the_woods.hpp"
#include "workbench/datasets/mrclam.hpp"
#include "workbench/datasets/planar_mono_slam.hpp"
#include "workbench/datasets/plaza.hpp"
#include "workbench/datasets/uwb_labyrinth.hpp"
#include "workbench/datasets/victoria_park.hpp"
#include "workbench/datasets/victoria_park_graph.hpp"
#include "workbench/logs/log_folder.hpp"

namespace waymark {
namespace {

namespace fs = std::filesystem;

/// Names of some of the files in a folder, "nothing" if there are none.
std::string some_content(const fs::path& folder) {
  constexpr std::size_t kShown = 5;
  std::vector<std::string> names;
  std::error_code failed;
  for (const auto& entry : fs::directory_iterator(folder, failed))
    names.push_back(entry.path().filename().string());
  if (names.empty()) return "nothing";
  std::ranges::sort(names);
  const std::size_t more = names.size() > kShown ? names.size() - kShown : 0;
  names.resize(names.size() - more);
  return fmt::format("{}{}", fmt::join(names, ", "), more > 0 ? fmt::format(" and {} more", more) : "");
}

Error not_a_log(const fs::path& folder) {
  return {fmt::format(
      "{} is a directory but no log: expected log.yaml with wheels.csv, velocity.csv, steering.csv or "
      "odometry.csv; or a bag's metadata.yaml; or MRCLAM's Barcodes.dat with RobotN_Odometry.dat; or a .mat "
      "file of Plaza, "
      "lost-in-the-woods, Victoria Park or the car park; or PlazaN_DR.txt with PlazaN_TD.txt; or "
      "Indoor_UWB_Input.txt; or camera.dat with trajectory.dat and world.dat; found {}",
      folder.string(), some_content(folder))};
}

Error not_a_folder(const fs::path& file) {
  const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
  if (is_log_folder(folder) || is_mrclam(folder) || is_uwb_labyrinth(folder) || is_planar_mono_slam(folder) ||
      !plaza_text_runs(folder).empty())
    return {fmt::format("{} is one file of a log; give its folder, {}", file.string(), folder.string())};
  std::error_code ignored;
  if (fs::is_regular_file(file, ignored) && fs::is_empty(file, ignored))
    return {file.string() + ": the file is empty; was its recording cut off?"};
  return {
      fmt::format("{} is no log: expected a log folder, a ROS bag, an MRCLAM directory, a .mat file of "
                  "Plaza, lost-in-the-woods, Victoria Park or the car park, or Victoria Park's graph",
                  file.string())};
}

bool is_mat_file(const fs::path& path) { return path.extension() == ".mat"; }

std::vector<fs::path> mat_files(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code failed;
  for (const auto& entry : fs::directory_iterator(folder, failed))
    if (is_mat_file(entry.path())) files.push_back(entry.path());
  std::ranges::sort(files);
  return files;
}

Result<std::unique_ptr<Source>> open_mat_file(const fs::path& path, const InputOptions& options) {
  const auto file = MatFile::open(path);
  if (!file) return file.error();
  if (is_plaza(*file)) return open_plaza(*file, options.fix_known_errors);
  if (is_lost_in_the_woods(*file)) return open_lost_in_the_woods(*file);
  if (is_victoria_park(*file)) return open_victoria_park(*file);
  if (is_car_park(*file)) return open_car_park(*file);
  return Error{fmt::format(
      "{} is no log: expected the variables of Plaza (GT, DR, TD), lost-in-the-woods (t, v, om, r, b, ...), "
      "Victoria Park (zt, TLsr, u, time) or the car park (Laser, Intensity, Velocity, ...); found {}",
      path.string(), file->names().empty() ? "none" : file->names())};
}

/// The recording that input.run asks for.
Result<fs::path> choose_run(const fs::path& folder, const std::vector<fs::path>& runs, int run) {
  if (static_cast<std::size_t>(run) <= runs.size()) return runs[static_cast<std::size_t>(run) - 1];
  return Error{
      fmt::format("{}: there is no run {}; input.run can be 1 to {}", folder.string(), run, runs.size())};
}

Result<std::unique_ptr<Source>> open_folder(const fs::path& folder, const InputOptions& options) {
  if (bag::is_bag(folder)) return open_bag_source(folder, options.bag);
  if (is_log_folder(folder)) return open_log_folder(folder);
  if (is_mrclam(folder)) return open_mrclam(folder, {options.robot, options.fix_known_errors});
  if (is_uwb_labyrinth(folder)) return open_uwb_labyrinth(folder);
  if (is_planar_mono_slam(folder))
    return open_planar_mono_slam(folder, {options.pixel_noise_px, options.seed});
  for (const char* name : {kVictoriaParkLog, kCarParkLog})
    if (fs::exists(folder / name)) return open_mat_file(folder / name, options);
  if (const auto files = mat_files(folder); !files.empty()) {
    const auto file = choose_run(folder, files, options.run);
    return file ? open_mat_file(*file, options) : file.error();
  }
  if (const auto runs = plaza_text_runs(folder); !runs.empty()) {
    const auto run = choose_run(folder, runs, options.run);
    return run ? open_plaza_text(*run) : run.error();
  }
  return not_a_log(folder);
}

}  // namespace

void describe(Schema& schema, InputOptions& options) {
  schema.integer("input.robot", options.robot, {1, 99}, "which robot, where a recording holds several");
  schema.integer("input.run", options.run, {1, 99},
                 "which recording of a folder that holds several, in the order of their names");
  schema.boolean("input.fix_known_errors", options.fix_known_errors,
                 "put right what is known to be wrong in a published recording");
  schema.real(
      "input.pixel_noise_px", options.pixel_noise_px, {0.0, 100.0},
      "standard deviation of the noise that is added to points recorded without any (planar-mono-slam), "
      "px");
  describe(schema, options.bag);
}

Result<std::unique_ptr<Source>> open_source(const fs::path& path, const InputOptions& options) {
  std::error_code failed;
  const auto status = fs::status(path, failed);
  if (status.type() == fs::file_type::not_found) return Error{"no such file or directory: " + path.string()};
  if (failed) return Error{"cannot read " + path.string() + ": " + failed.message()};
  if (fs::is_directory(status)) return open_folder(path, options);
  if (is_mat_file(path)) return open_mat_file(path, options);
  if (bag::is_bag(path)) return open_bag_source(path, options.bag);
  if (is_victoria_park_graph(path)) return open_victoria_park_graph(path);
  return not_a_folder(path);
}

}  // namespace waymark
