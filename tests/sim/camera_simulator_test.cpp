#include "workbench/sim/camera_simulator.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "workbench/sim/rooms.hpp"

namespace waymark::sim {
namespace {

/// Errors of all kinds switched off.
CameraSimulatorOptions ideal_camera_simulator() {
  CameraSimulatorOptions camera_simulator;
  camera_simulator.noise_grey = camera_simulator.exposure_ms = 0.0;
  camera_simulator.drift_ratio = camera_simulator.jump_ratio = 0.0;
  camera_simulator.vibration_pitch_deg = camera_simulator.vibration_roll_deg =
      camera_simulator.vibration_height_m = 0.0;
  return camera_simulator;
}

SimOptions small_room() {
  SimOptions options = *scenario("room");
  options.path.side_m = 2.0;
  options.room.walkers = 0;
  return options;
}

/// A camera simulator of a small room. The seed is of the scene and the drive too.
struct Take {
  explicit Take(const CameraSimulatorOptions& camera_simulator_options, SimOptions options = small_room(),
                int threads = 1)
      : path(make_path(options.path, 3)),
        driven(drive(path, options, 3)),
        camera_simulator(camera_simulator_options, build_scene(options.room, path, 3), driven, 3, threads) {}

  Path path;
  Drive driven;
  CameraSimulator camera_simulator;
};

/// Mean and standard deviation of the difference of two images, where neither is black or white.
std::pair<double, double> difference_of(const GreyImage& a, const GreyImage& b) {
  double n = 0.0, sum = 0.0, squares = 0.0;
  for (int v = 0; v < a.height_px(); ++v) {
    for (int u = 0; u < a.width_px(); ++u) {
      if (b(u, v) < 20 || b(u, v) > 235) continue;
      const double d = a(u, v) - b(u, v);
      n += 1.0;
      sum += d;
      squares += d * d;
    }
  }
  return {sum / n, std::sqrt(squares / n - sum / n * sum / n)};
}

TEST(CameraSimulator, NoiseHasItsStandardDeviationAndIsAnotherInEveryImage) {
  CameraSimulatorOptions noisy = ideal_camera_simulator();
  noisy.noise_grey = 3.0;
  Take clean(ideal_camera_simulator()), grainy(noisy);
  const GreyImage first = grainy.camera_simulator.take(40);
  const auto [mean, sigma] = difference_of(first, clean.camera_simulator.take(40));
  EXPECT_NEAR(mean, 0.0, 0.05);
  EXPECT_NEAR(sigma, std::sqrt(9.0 + 1.0 / 6.0), 0.1);  // both are rounded
  EXPECT_NE(first, grainy.camera_simulator.take(41));
}

TEST(CameraSimulator, AnImageDependsOnItsNumberAlone) {
  Take one{CameraSimulatorOptions{}};
  Take other(CameraSimulatorOptions{}, small_room(), 3);
  const GreyImage late = one.camera_simulator.take(100);
  (void)one.camera_simulator.take(3);
  EXPECT_EQ(one.camera_simulator.take(100), late);
  EXPECT_EQ(other.camera_simulator.take(100), late);
}

TEST(CameraSimulator, CameraStandsWhereItsModelSaysWithoutVibration) {
  const Take take(ideal_camera_simulator());
  const Camera camera(camera_of(ideal_camera_simulator()));
  const Stamp when = take.camera_simulator.stamp(77);
  const CameraPose pose = camera.pose(take.driven.at(when));
  const Viewpoint from = take.camera_simulator.viewpoint(when);
  EXPECT_NEAR((from.R_camera_world - pose.R_camera_world).norm(), 0.0, 1e-12);
  EXPECT_NEAR((from.p_world_camera - pose.p_world_camera).norm(), 0.0, 1e-12);
}

TEST(CameraSimulator, VibrationHasMeanZeroAndDeviationOne) {
  const Vibration vibration(RandomStream(1, StreamPurpose::kImages));
  double sum = 0.0, squares = 0.0;
  constexpr int kSamples = 20000;
  for (int i = 0; i < kSamples; ++i) {
    const double x = vibration.at(i * 0.01);
    sum += x;
    squares += x * x;
  }
  EXPECT_NEAR(sum / kSamples, 0.0, 0.02);
  EXPECT_NEAR(std::sqrt(squares / kSamples), 1.0, 0.02);
}

TEST(CameraSimulator, VibrationTurnsAndLiftsTheCamera) {
  CameraSimulatorOptions shaking = ideal_camera_simulator();
  shaking.vibration_height_m = 0.01;
  shaking.vibration_pitch_deg = 1.0;
  const Take calm(ideal_camera_simulator()), shaken(shaking);
  double lifts = 0.0, nods = 0.0;
  for (std::size_t i = 0; i < 300; ++i) {
    const Viewpoint a = calm.camera_simulator.viewpoint(calm.camera_simulator.stamp(i));
    const Viewpoint b = shaken.camera_simulator.viewpoint(calm.camera_simulator.stamp(i));
    lifts += std::pow(b.p_world_camera.z() - a.p_world_camera.z(), 2.0);
    EXPECT_NEAR(b.R_camera_world(0, 2), 0.0, 1e-12);  // does not roll
    nods += std::pow(b.R_camera_world(2, 2), 2.0);    // height of the optical axis
  }
  EXPECT_NEAR(std::sqrt(lifts / 300.0), 0.01, 0.002);
  EXPECT_NEAR(std::sqrt(nods / 300.0), to_radians(1.0), 0.2 * to_radians(1.0));
}

TEST(CameraSimulator, BrightnessDriftsSlowlyAndJumpsSuddenly) {
  CameraSimulatorOptions changing = ideal_camera_simulator();
  changing.drift_ratio = 0.1;
  changing.jump_ratio = 0.5;
  changing.jump_interval_s = 4.0;
  const Take take(changing);
  const auto ratio = [&](double from_s, double to_s) {
    return take.camera_simulator.brightness(stamp_from_seconds(to_s)) /
           take.camera_simulator.brightness(stamp_from_seconds(from_s));
  };
  for (int i = 0; i < 4; ++i) EXPECT_NEAR(ratio(i * 4.0 + 0.1, i * 4.0 + 0.2), 1.0, 0.01);
  double largest = 0.0;
  for (int i = 1; i < 6; ++i)
    largest = std::max(largest, std::abs(ratio(i * 4.0 - 0.01, i * 4.0 + 0.01) - 1.0));
  EXPECT_GT(largest, 0.05);
}

TEST(CameraSimulator, ImageGetsBrighterByTheBrightness) {
  CameraSimulatorOptions bright = ideal_camera_simulator();
  bright.brightness = 1.3;
  Take plain(ideal_camera_simulator()), brighter(bright);
  const GreyImage a = plain.camera_simulator.take(10), b = brighter.camera_simulator.take(10);
  int compared = 0;
  for (int u = 0; u < 320; ++u) {
    if (a(u, 100) > 190) continue;
    ASSERT_NEAR(b(u, 100), 1.3 * a(u, 100), 1.2);
    ++compared;
  }
  EXPECT_GT(compared, 100);
}

TEST(CameraSimulator, ACoveredLensShowsNothingButNoise) {
  CameraSimulatorOptions covered;
  covered.covered_from_s = 1.0;
  covered.covered_for_s = 2.0;
  Take take(covered);
  const auto lightest = [&](std::size_t image) {
    const GreyImage taken = take.camera_simulator.take(image);
    return *std::max_element(taken.data(), taken.data() + 320 * 240);
  };
  EXPECT_GT(lightest(29), 100);
  EXPECT_LT(lightest(30), 12);
  EXPECT_LT(lightest(89), 12);
  EXPECT_GT(lightest(90), 100);
}

TEST(CameraSimulator, StampsAndNumbersOfImagesAreInverse) {
  const Take take(ideal_camera_simulator());
  for (std::size_t i = 0; i < take.camera_simulator.size(); ++i)
    ASSERT_EQ(take.camera_simulator.number(take.camera_simulator.stamp(i)), i);
}

double sharpness_across(const GreyImage& image) {
  double sum = 0.0;
  for (int v = 0; v < image.height_px(); ++v)
    for (int u = 0; u + 1 < image.width_px(); ++u) sum += std::pow(image(u + 1, v) - image(u, v), 2.0);
  return sum;
}

TEST(CameraSimulator, TurningSmearsWhatALongExposureSees) {
  SimOptions options = small_room();
  options.path.corner_radius_m = 0.0;
  CameraSimulatorOptions slow = ideal_camera_simulator();
  slow.exposure_ms = 20.0;
  Take sharp(ideal_camera_simulator(), options), smeared(slow, options);
  const std::size_t turning = sharp.driven.corners.front() + 30;  // a second after it began to turn
  EXPECT_LT(sharpness_across(smeared.camera_simulator.take(turning)),
            0.7 * sharpness_across(sharp.camera_simulator.take(turning)));
}

TEST(CameraSimulator, SomebodyWalkingChangesAPartOfTheImage) {
  SimOptions options = small_room();
  Take empty(ideal_camera_simulator(), options);
  options.room.walkers = 8;
  Take busy(ideal_camera_simulator(), options);
  int seen = 0;
  for (std::size_t i = 0; i < empty.camera_simulator.size(); i += 25)
    if (empty.camera_simulator.take(i) != busy.camera_simulator.take(i)) ++seen;
  EXPECT_GT(seen, 3);
}

}  // namespace
}  // namespace waymark::sim
