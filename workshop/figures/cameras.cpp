#include "workshop/figures/cameras.hpp"

#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "workbench/calibrate/camera_calibration.hpp"
#include "workshop/figures/over_runs.hpp"
#include "workshop/figures/simulated_board.hpp"

namespace waymark {
namespace {

using namespace calibrate;
using simulated::Flaws;
using simulated::Poses;

/// Photographs of one camera and, where `others` is not 0, of another.
struct Scene {
  const char* name;
  std::size_t views = 15;
  Poses poses;
  Flaws flaws;
  double bend_m = 0.0;  ///< standard deviation of how the board is bent
  CameraOptions camera = simulated::true_camera();
  std::size_t others = 0;
  CameraOptions other;
};

CameraOptions with_k3(double k3) {
  CameraOptions camera = simulated::true_camera();
  camera.distortion.k3 = k3;
  return camera;
}

CameraOptions zoomed(double by) {
  CameraOptions camera = simulated::true_camera();
  camera.fu_px *= by;
  camera.fv_px *= by;
  return camera;
}

/// As different as the two cameras of calib-chessboard are.
CameraOptions of_the_same_make() {
  CameraOptions camera = zoomed(1.008);
  camera.cu_px -= 15.0;
  camera.cv_px += 15.0;
  camera.distortion.k1 -= 0.013;
  return camera;
}

constexpr Poses kFacing{.tilt_deg = 5.0, .nearest_m = 0.4, .farthest_m = 0.5};
constexpr Poses kHardlyTilted{.tilt_deg = 15.0};

std::vector<Scene> with_independent_errors() {
  return {{.name = "8 views", .views = 8},
          {.name = "12 views", .views = 12},
          {.name = "20 views", .views = 20},
          {.name = "30 views", .views = 30},
          {.name = "15 views, noise 1 px", .flaws = {.noise_px = 1.0}},
          {.name = "15 views, noise 0.03 px", .flaws = {.noise_px = 0.03}},
          {.name = "15 views, uneven noise", .flaws = {.uneven = 2.0}},
          {.name = "10 views, tilted by 5 deg", .views = 10, .poses = kFacing},
          {.name = "15 views, tilted by 5 deg", .poses = kFacing},
          {.name = "15 views, tilted by 15 deg", .poses = kHardlyTilted},
          {.name = "12 views in a corner", .views = 12, .poses = {.farthest_m = 0.9, .part = 0.6}}};
}

std::vector<Scene> with_common_errors() {
  return {
      {.name = "15 views, bent by 1 mm", .bend_m = 0.001},
      {.name = "15 views, bent by 3 mm", .bend_m = 0.003},
      {.name = "25 views, bent by 1 mm", .views = 25, .bend_m = 0.001},
      {.name = "10 views, flexing by 0.5 mm", .views = 10, .flaws = {.flex_m = 0.0005}},
      {.name = "15 views, flexing by 1 mm", .flaws = {.flex_m = 0.001}},
      {.name = "15 views, flexing by 3 mm", .flaws = {.flex_m = 0.003}},
      {.name = "30 views, flexing by 1 mm", .views = 30, .flaws = {.flex_m = 0.001}},
      {.name = "12 views, 5 deg, flexing by 1 mm", .views = 12, .poses = kFacing, .flaws = {.flex_m = 0.001}},
      {.name = "15 views, 15 deg, flexing by 2 mm", .poses = kHardlyTilted, .flaws = {.flex_m = 0.002}},
      {.name = "15 views, rolling by 2 px", .flaws = {.rolling_px = 2.0}},
      {.name = "13 views, rolling by 5 px", .views = 13, .flaws = {.rolling_px = 5.0}},
      {.name = "15 views, k3 = 0.3", .camera = with_k3(0.3)},
      {.name = "25 views, k3 = 0.5", .views = 25, .camera = with_k3(0.5)},
      {.name = "15 views, fisheye", .flaws = {.fisheye = true}},
      {.name = "25 views, fisheye", .views = 25, .flaws = {.fisheye = true}}};
}

std::vector<Scene> of_two_cameras() {
  const CameraOptions alike = of_the_same_make();
  return {
      {.name = "13 + 13, same make", .views = 13, .others = 13, .other = alike},
      {.name = "8 + 8, same make", .views = 8, .others = 8, .other = alike},
      {.name = "12 + 3, same make", .views = 12, .others = 3, .other = alike},
      {.name = "10 + 10, focus by 2 %", .views = 10, .others = 10, .other = zoomed(1.02)},
      {.name = "8 + 8, focus by 5 %", .views = 8, .others = 8, .other = zoomed(1.05)},
      {.name = "8 + 8, 10 %, bent by 1 mm", .views = 8, .bend_m = 0.001, .others = 8, .other = zoomed(1.1)},
      {.name = "8 + 8, zoom by 1.5", .views = 8, .others = 8, .other = zoomed(1.5)},
      {.name = "12 + 3, zoom by 2", .views = 12, .others = 3, .other = zoomed(2.0)}};
}

/// Those of the other camera lie anywhere among the first's.
struct Photographs {
  std::vector<BoardCorners> corners;
  std::vector<bool> is_other;
};

Photographs take(const Scene& scene, int seed) {
  RandomStream random(static_cast<std::uint64_t>(seed), StreamPurpose::kSimulation);
  Flaws flaws = scene.flaws;
  flaws.bend_m = scene.bend_m * Eigen::Vector3d(random.normal(), random.normal(), random.normal());
  const auto photograph = [&](const CameraOptions& camera, std::size_t count) {
    return simulated::photograph(simulated::chessboard(), camera, count, scene.poses, flaws, random);
  };
  Photographs all{photograph(scene.camera, scene.views), std::vector<bool>(scene.views)};
  for (const BoardCorners& corners : photograph(scene.other, scene.others)) {
    const auto place =
        static_cast<std::ptrdiff_t>(random.uniform(0.0, 1.0 + static_cast<double>(all.corners.size())));
    all.corners.insert(all.corners.begin() + place, corners);
    all.is_other.insert(all.is_other.begin() + place, true);
  }
  return all;
}

/// The first group has the first view, whichever camera that is of.
bool is_exact(const TwoCameras& split, const std::vector<bool>& is_other) {
  const auto of_its_own = [&](std::size_t i) { return is_other[i] == is_other[0]; };
  return std::ranges::all_of(split.groups[0].views, of_its_own) &&
         std::ranges::none_of(split.groups[1].views, of_its_own);
}

/// What became of one set.
struct SplitOutcome {
  double contrast = 0.0;     ///< 0 where no two groups give a camera each
  double together_px = 0.0;  ///< RMS by one camera
  bool is_exact = false;
};

/// As calibrate_camera() comes to its two_cameras, whatever the contrast.
SplitOutcome split(const Scene& scene, int seed) {
  const Photographs photographs = take(scene, seed);
  const auto calibration = calibrate_camera(simulated::chessboard(), simulated::named(photographs.corners));
  if (!calibration) return {};
  const auto found = find_two_cameras(calibration->board, calibration->views, 0.0);
  if (!found) return {};
  return {found->contrast, found->together_px, is_exact(*found, photographs.is_other)};
}

std::vector<SplitOutcome> split_all(const Scene& scene, int seeds) {
  std::vector<SplitOutcome> outcomes(static_cast<std::size_t>(seeds));
  for_all_runs(seeds, [&](int i) { outcomes[static_cast<std::size_t>(i)] = split(scene, i + 1); });
  return outcomes;
}

bool is_found(const SplitOutcome& outcome) { return outcome.contrast >= kContrast; }

double largest_not_found(const std::vector<SplitOutcome>& outcomes) {
  double largest = 0.0;
  for (const SplitOutcome& one : outcomes)
    if (!is_found(one)) largest = std::max(largest, one.contrast);
  return largest;
}

void print(const std::string& name, const std::vector<SplitOutcome>& outcomes) {
  fmt::print("{:<36}{:>6}{:>8}{:>12.2f}{:>12.2f}", name, outcomes.size(),
             std::ranges::count_if(outcomes, is_found),
             std::ranges::max(outcomes, {}, &SplitOutcome::contrast).contrast, largest_not_found(outcomes));
}

/// Which sets of one camera were taken for two.
void print_found(const std::vector<SplitOutcome>& outcomes) {
  for (std::size_t i = 0; i < outcomes.size(); ++i)
    if (is_found(outcomes[i]))
      fmt::print("    set {}: contrast {:.2f}, RMS {:.2f} px by one camera\n", i + 1, outcomes[i].contrast,
                 outcomes[i].together_px);
}

void print_one_camera(const char* errors, const std::vector<Scene>& scenes, int seeds) {
  if (scenes.empty()) return;
  std::vector<SplitOutcome> all;
  for (const Scene& scene : scenes) {
    const auto outcomes = split_all(scene, seeds);
    print(scene.name, outcomes);
    fmt::print("\n");
    print_found(outcomes);
    all.insert(all.end(), outcomes.begin(), outcomes.end());
  }
  print(errors, all);
  fmt::print("\n");
}

void print_two_cameras(const std::vector<Scene>& scenes, int seeds) {
  for (const Scene& scene : scenes) {
    const auto outcomes = split_all(scene, seeds);
    print(scene.name, outcomes);
    fmt::print("{:>8}\n", std::ranges::count_if(outcomes, [](const SplitOutcome& one) {
                 return is_found(one) && one.is_exact;
               }));
  }
}

struct CamerasRequest {
  int seeds = 20;
  std::string only;  ///< empty: all kinds of sets
};

/// Those whose name has the text in it.
std::vector<Scene> only(const std::string& text, std::vector<Scene> scenes) {
  std::erase_if(scenes, [&text](const Scene& scene) {
    return std::string_view(scene.name).find(text) == std::string_view::npos;
  });
  return scenes;
}

void cameras(const CamerasRequest& request) {
  fmt::print("{:<36}{:>6}{:>8}{:>12}{:>12}{:>8}\n", "contrast", "sets", "found", "largest", "not found",
             "exact");
  print_one_camera("one camera, errors independent", only(request.only, with_independent_errors()),
                   request.seeds);
  print_one_camera("one camera, errors in common", only(request.only, with_common_errors()), request.seeds);
  print_two_cameras(only(request.only, of_two_cameras()), request.seeds);
}

}  // namespace

void add_cameras(CLI::App& app) {
  auto* command =
      app.add_subcommand("cameras", "how often photographs of a board from two cameras are detected");
  auto request = std::make_shared<CamerasRequest>();
  command->add_option("--seeds", request->seeds, "sets of each kind")->check(CLI::PositiveNumber);
  command->add_option("--only", request->only, "kinds whose name has this in it");
  command->callback([request] { cameras(*request); });
}

}  // namespace waymark
