#include "workbench/sim/film.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "workbench/sim/rooms.hpp"

namespace waymark::sim {
namespace {

/// Errors of all kinds switched off.
FilmOptions ideal_film() {
  FilmOptions film;
  film.noise_grey = film.exposure_ms = 0.0;
  film.drift_ratio = film.jump_ratio = 0.0;
  film.vibration_pitch_deg = film.vibration_roll_deg = film.vibration_height_m = 0.0;
  return film;
}

SimOptions small_room() {
  SimOptions options = *scenario("room");
  options.path.side_m = 2.0;
  options.room.walkers = 0;
  return options;
}

/// A film of a small room. The seed is of the scene and the drive too.
struct Take {
  explicit Take(const FilmOptions& film_options, SimOptions options = small_room(), int threads = 1)
      : path(make_path(options.path, 3)),
        driven(drive(path, options, 3)),
        film(film_options, build_scene(options.room, path, 3), driven, 3, threads) {}

  Path path;
  Drive driven;
  Film film;
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

TEST(Film, NoiseHasItsStandardDeviationAndIsAnotherInEveryImage) {
  FilmOptions noisy = ideal_film();
  noisy.noise_grey = 3.0;
  Take clean(ideal_film()), grainy(noisy);
  const GreyImage first = grainy.film.take(40);
  const auto [mean, sigma] = difference_of(first, clean.film.take(40));
  EXPECT_NEAR(mean, 0.0, 0.05);
  EXPECT_NEAR(sigma, std::sqrt(9.0 + 1.0 / 6.0), 0.1);  // both are rounded
  EXPECT_NE(first, grainy.film.take(41));
}

TEST(Film, AnImageDependsOnItsNumberAlone) {
  Take one{FilmOptions{}};
  Take other(FilmOptions{}, small_room(), 3);
  const GreyImage late = one.film.take(100);
  (void)one.film.take(3);
  EXPECT_EQ(one.film.take(100), late);
  EXPECT_EQ(other.film.take(100), late);
}

TEST(Film, CameraStandsWhereItsModelSaysWithoutVibration) {
  const Take take(ideal_film());
  const Camera camera(camera_of(ideal_film()));
  const Stamp when = take.film.stamp(77);
  const CameraPose pose = camera.pose(take.driven.at(when));
  const Viewpoint from = take.film.viewpoint(when);
  EXPECT_NEAR((from.R_camera_world - pose.R_camera_world).norm(), 0.0, 1e-12);
  EXPECT_NEAR((from.p_world_camera - pose.p_world_camera).norm(), 0.0, 1e-12);
}

TEST(Film, VibrationHasMeanZeroAndDeviationOne) {
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

TEST(Film, VibrationTurnsAndLiftsTheCamera) {
  FilmOptions shaking = ideal_film();
  shaking.vibration_height_m = 0.01;
  shaking.vibration_pitch_deg = 1.0;
  const Take calm(ideal_film()), shaken(shaking);
  double lifts = 0.0, nods = 0.0;
  for (std::size_t i = 0; i < 300; ++i) {
    const Viewpoint a = calm.film.viewpoint(calm.film.stamp(i));
    const Viewpoint b = shaken.film.viewpoint(calm.film.stamp(i));
    lifts += std::pow(b.p_world_camera.z() - a.p_world_camera.z(), 2.0);
    EXPECT_NEAR(b.R_camera_world(0, 2), 0.0, 1e-12);  // does not roll
    nods += std::pow(b.R_camera_world(2, 2), 2.0);    // height of the optical axis
  }
  EXPECT_NEAR(std::sqrt(lifts / 300.0), 0.01, 0.002);
  EXPECT_NEAR(std::sqrt(nods / 300.0), to_radians(1.0), 0.2 * to_radians(1.0));
}

TEST(Film, BrightnessDriftsSlowlyAndJumpsSuddenly) {
  FilmOptions changing = ideal_film();
  changing.drift_ratio = 0.1;
  changing.jump_ratio = 0.5;
  changing.jump_interval_s = 4.0;
  const Take take(changing);
  const auto ratio = [&](double from_s, double to_s) {
    return take.film.brightness(stamp_from_seconds(to_s)) / take.film.brightness(stamp_from_seconds(from_s));
  };
  for (int i = 0; i < 4; ++i) EXPECT_NEAR(ratio(i * 4.0 + 0.1, i * 4.0 + 0.2), 1.0, 0.01);
  double largest = 0.0;
  for (int i = 1; i < 6; ++i)
    largest = std::max(largest, std::abs(ratio(i * 4.0 - 0.01, i * 4.0 + 0.01) - 1.0));
  EXPECT_GT(largest, 0.05);
}

TEST(Film, ImageGetsBrighterByTheBrightness) {
  FilmOptions bright = ideal_film();
  bright.brightness = 1.3;
  Take plain(ideal_film()), brighter(bright);
  const GreyImage a = plain.film.take(10), b = brighter.film.take(10);
  int compared = 0;
  for (int u = 0; u < 320; ++u) {
    if (a(u, 100) > 190) continue;
    ASSERT_NEAR(b(u, 100), 1.3 * a(u, 100), 1.2);
    ++compared;
  }
  EXPECT_GT(compared, 100);
}

TEST(Film, ACoveredLensShowsNothingButNoise) {
  FilmOptions covered;
  covered.covered_from_s = 1.0;
  covered.covered_for_s = 2.0;
  Take take(covered);
  const auto lightest = [&](std::size_t image) {
    const GreyImage taken = take.film.take(image);
    return *std::max_element(taken.data(), taken.data() + 320 * 240);
  };
  EXPECT_GT(lightest(29), 100);
  EXPECT_LT(lightest(30), 12);
  EXPECT_LT(lightest(89), 12);
  EXPECT_GT(lightest(90), 100);
}

TEST(Film, StampsAndNumbersOfImagesAreInverse) {
  const Take take(ideal_film());
  for (std::size_t i = 0; i < take.film.size(); ++i) ASSERT_EQ(take.film.number(take.film.stamp(i)), i);
}

double sharpness_across(const GreyImage& image) {
  double sum = 0.0;
  for (int v = 0; v < image.height_px(); ++v)
    for (int u = 0; u + 1 < image.width_px(); ++u) sum += std::pow(image(u + 1, v) - image(u, v), 2.0);
  return sum;
}

TEST(Film, TurningSmearsWhatALongExposureSees) {
  SimOptions options = small_room();
  options.path.corner_radius_m = 0.0;
  FilmOptions slow = ideal_film();
  slow.exposure_ms = 20.0;
  Take sharp(ideal_film(), options), smeared(slow, options);
  const std::size_t turning = sharp.driven.corners.front() + 30;  // a second after it began to turn
  EXPECT_LT(sharpness_across(smeared.film.take(turning)), 0.7 * sharpness_across(sharp.film.take(turning)));
}

TEST(Film, SomebodyWalkingChangesAPartOfTheImage) {
  SimOptions options = small_room();
  Take empty(ideal_film(), options);
  options.room.walkers = 8;
  Take busy(ideal_film(), options);
  int seen = 0;
  for (std::size_t i = 0; i < empty.film.size(); i += 25)
    if (empty.film.take(i) != busy.film.take(i)) ++seen;
  EXPECT_GT(seen, 3);
}

}  // namespace
}  // namespace waymark::sim
