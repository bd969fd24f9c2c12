#include "workbench/run/input_formats.hpp"

#include <array>

#include "workbench/bags/bag_source.hpp"
#include "workbench/bags/live_recording.hpp"
#include "workbench/bags/open_bag.hpp"
#include "workbench/datasets/car_park.hpp"
#include "workbench/datasets/landmark_graph.hpp"
#include "workbench/datasets/lost_in_the_woods.hpp"
#include "workbench/datasets/mrclam.hpp"
#include "workbench/datasets/planar_mono_slam.hpp"
#include "workbench/datasets/plaza.hpp"
#include "workbench/datasets/uwb_labyrinth.hpp"
#include "workbench/datasets/victoria_park.hpp"
#include "workbench/datasets/victoria_park_graph.hpp"
#include "workbench/logs/log_folder.hpp"
#include "workbench/run/choose_run.hpp"
#include "workbench/run/mat_logs.hpp"

namespace waymark {
namespace {

namespace fs = std::filesystem;
using Place = InputFormat::Place;

bool has_plaza_text(const fs::path& folder) { return !plaza_text_runs(folder).empty(); }

/// A folder whose log.yaml says what it is may hold a bag besides.
bool is_bag_and_no_log_folder(const fs::path& path) { return !names_log_folder(path) && bag::is_bag(path); }

Result<std::unique_ptr<Source>> open_plaza_text_run(const fs::path& folder, const InputOptions& options) {
  const auto path = choose_run(folder, plaza_text_runs(folder), options.run);
  return path ? open_plaza_text(*path, options.fix_known_errors) : path.error();
}

}  // namespace

std::span<const InputFormat> input_formats() {
  static const std::array kFormats{
      InputFormat{"a recording of `waymark live`", "an .mcap file that it wrote", Place::kFile,
                  is_live_recording,
                  [](const fs::path& path, const InputOptions&) { return open_live_recording(path); }},
      InputFormat{"a ROS bag", "a bag's metadata.yaml, or its .db3 or .mcap files", Place::kEither,
                  is_bag_and_no_log_folder,
                  [](const fs::path& path, const InputOptions& options) {
                    return open_bag_source(path, options.bag);
                  }},
      InputFormat{"a log folder", "log.yaml with wheels.csv, velocity.csv, steering.csv or odometry.csv",
                  Place::kFolder, is_log_folder,
                  [](const fs::path& folder, const InputOptions&) { return open_log_folder(folder); }},
      InputFormat{"an MRCLAM directory", "MRCLAM's Barcodes.dat with RobotN_Odometry.dat", Place::kFolder,
                  is_mrclam,
                  [](const fs::path& folder, const InputOptions& options) {
                    return open_mrclam(folder, {options.robot, options.fix_known_errors});
                  }},
      InputFormat{"the folder of the UWB labyrinth", "Indoor_UWB_Input.txt", Place::kFolder, is_uwb_labyrinth,
                  [](const fs::path& folder, const InputOptions&) { return open_uwb_labyrinth(folder); }},
      InputFormat{"the folder of planar-mono-slam", "camera.dat with trajectory.dat and world.dat",
                  Place::kFolder, is_planar_mono_slam,
                  [](const fs::path& folder, const InputOptions& options) {
                    return open_planar_mono_slam(folder, {options.pixel_noise_px, options.seed});
                  }},
      InputFormat{mat_logs_expected(), mat_logs_expected(), Place::kEither, is_mat_log, open_mat_log},
      InputFormat{"the folder of Plaza as text", "PlazaN_DR.txt with PlazaN_TD.txt", Place::kFolder,
                  has_plaza_text,
                  [](const fs::path& folder, const InputOptions& options) {
                    return open_plaza_text_run(folder, options);
                  }},
      InputFormat{"Victoria Park's graph", "a .txt file that begins with ODOMETRY", Place::kFile,
                  is_victoria_park_graph,
                  [](const fs::path& file, const InputOptions&) { return open_victoria_park_graph(file); }},
      InputFormat{"a folder of ROS 1 bags", "the .bag files of one recording", Place::kEither,
                  bag::is_folder_of_bags,
                  [](const fs::path& path, const InputOptions& options) {
                    return open_bag_source(path, options.bag);
                  }},
      InputFormat{"a landmark graph of g2o or PyFactorGraph", "a file that begins with VERTEX_SE2",
                  Place::kFile, is_landmark_graph,
                  [](const fs::path& file, const InputOptions&) { return open_landmark_graph(file); }}};
  return kFormats;
}

std::span<const MatFormat> mat_formats() {
  static const std::array kFormats{
      MatFormat{"Plaza", "GT, DR, TD", "", is_plaza,
                [](const MatFile& file, const InputOptions& options) {
                  return open_plaza(file, options.fix_known_errors);
                }},
      MatFormat{"lost-in-the-woods", "t, v, om, r, b, ...", "", is_lost_in_the_woods,
                [](const MatFile& file, const InputOptions&) { return open_lost_in_the_woods(file); }},
      MatFormat{"Victoria Park", "zt, TLsr, u, time", kVictoriaParkLog, is_victoria_park,
                [](const MatFile& file, const InputOptions&) { return open_victoria_park(file); }},
      MatFormat{"the car park", "Laser, Intensity, Velocity, ...", kCarParkLog, is_car_park,
                [](const MatFile& file, const InputOptions&) { return open_car_park(file); }}};
  return kFormats;
}

}  // namespace waymark
