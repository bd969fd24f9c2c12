// The tracker in images of a rendered room, whose every pixel is known to be of a point in space.
#include <algorithm>
#include <cstdio>
#include <limits>
#include <map>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <gtest/gtest.h>

#include "waymark/core/angle.hpp"
#include "waymark/vision/tracker.hpp"

#include "known_points.hpp"
#include "workbench/sim/camera_simulator.hpp"
#include "workbench/sim/rooms.hpp"

namespace waymark::vision {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

/// What is seen along a ray.
std::optional<Vector3d> first_on_ray(const std::vector<sim::Rectangle>& rectangles, const Vector3d& from,
                                     const Vector3d& direction) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const sim::Rectangle& r : rectangles) {
    const double towards = direction.dot(r.normal());
    if (towards >= 0.0) continue;  // from behind it is invisible
    const double distance = (r.corner_m - from).dot(r.normal()) / towards;
    const Vector3d on = from + distance * direction - r.corner_m;
    const double s = on.dot(r.along_s), t = on.dot(r.along_t);
    const bool is_inside = r.endless || (s >= 0.0 && s <= r.width_m && t >= 0.0 && t <= r.height_m);
    if (is_inside && distance > 0.0) nearest = std::min(nearest, distance);
  }
  if (!std::isfinite(nearest)) return std::nullopt;
  return from + nearest * direction;
}

/// A drive through a room without people, and what its camera takes.
struct Room {
  explicit Room(std::uint64_t seed, sim::CameraSimulatorOptions camera_simulator_options = calm())
      : options(*sim::scenario("room")),
        path(sim::make_path(options.path, seed)),
        driven(sim::drive(path, options, seed)),
        scene(sim::build_scene(without_people(options.room), path, seed)),
        rectangles(scene.rectangles),
        camera(sim::camera_of(camera_simulator_options)),
        camera_simulator(camera_simulator_options, std::move(scene), driven, seed, 1) {}

  static sim::CameraSimulatorOptions calm() {
    sim::CameraSimulatorOptions camera_simulator;
    camera_simulator.vibration_pitch_deg = camera_simulator.vibration_roll_deg =
        camera_simulator.vibration_height_m = 0.0;
    camera_simulator.drift_ratio = camera_simulator.jump_ratio = 0.0;
    return camera_simulator;
  }
  static sim::RoomOptions without_people(sim::RoomOptions room) {
    room.walkers = 0;
    return room;
  }

  [[nodiscard]] Pose2 pose(std::size_t image) const { return driven.at(camera_simulator.stamp(image)); }
  [[nodiscard]] std::optional<Vector3d> point_at(const Vector2d& pixel, std::size_t image) const {
    const CameraPose from = camera.pose(pose(image));
    const auto ray = camera.ray(pixel);
    if (!ray) return std::nullopt;
    return first_on_ray(rectangles, from.p_world_camera,
                        from.R_camera_world.transpose() * ray->xy.homogeneous());
  }

  sim::SimOptions options;
  sim::Path path;
  sim::Drive driven;
  sim::Scene scene;
  std::vector<sim::Rectangle> rectangles;
  Camera camera;
  sim::CameraSimulator camera_simulator;
};

/// By how much a match was off, and the way from the point to the camera that saw it.
struct Seen {
  Vector2d error_px;
  Vector3d view_m;
};

struct Errors {
  std::vector<double> distances_px;
  std::map<LandmarkId, std::vector<Seen>> matches;
  std::vector<double> nis;
  int found = 0, missed = 0;
  void add(const Vector2d& error, const Eigen::Matrix2d& R) {
    distances_px.push_back(error.norm());
    nis.push_back(error.dot(R.inverse() * error));
  }
  [[nodiscard]] static double quantile(std::vector<double> values, double part) {
    std::ranges::sort(values);
    return values[static_cast<std::size_t>(part * static_cast<double>(values.size() - 1))];
  }
};

Errors follow(Room& room, std::size_t images, std::size_t step, const Eigen::Matrix2d& S,
              const SearchOptions& search = {}) {
  Tracker tracker({}, search, room.camera, 1);
  test::KnownPoints points(room.camera);
  RandomStream random(5, StreamPurpose::kWorld);
  Errors errors;
  for (std::size_t i = 0; i < images; i += step) {
    const GreyImage image = room.camera_simulator.take(i);
    std::vector<Innovation> innovations;
    const auto correct = [&](Round round, const SearchOutcome& observations) {
      if (round == Round::kCandidates) {
        innovations =
            points.take(observations, [&](const Vector2d& pixel) { return room.point_at(pixel, i); });
        return Correction{innovations, {}};
      }
      errors.found += static_cast<int>(observations.found.size());
      errors.missed += static_cast<int>(observations.missed.size());
      for (const Observation& seen : observations.found) {
        const Vector2d error = test::place_of(seen) - *points.pixel(*seen.id, room.pose(i));
        errors.add(error, *seen.covariance);
        errors.matches[*seen.id].push_back(
            {error, room.camera.pose(room.pose(i)).p_world_camera - points.place(*seen.id)});
      }
      return Correction{};
    };
    tracker.track(image, room.pose(i), points.expect(room.pose(i), S, random), correct);
  }
  return errors;
}

/// Follows a drive for three seconds, ten images per second.
void expect_right_places(const sim::CameraSimulatorOptions& camera_simulator) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    Room room(seed, camera_simulator);
    const Errors errors = follow(room, 90, 3, 9.0 * Eigen::Matrix2d::Identity());
    std::printf("seed %d: %d found, %d missed; error median %.3f px, 80 %% below %.2f, 95 %% below %.2f\n",
                static_cast<int>(seed), errors.found, errors.missed,
                Errors::quantile(errors.distances_px, 0.5), Errors::quantile(errors.distances_px, 0.8),
                Errors::quantile(errors.distances_px, 0.95));
    EXPECT_GT(2 * errors.found, errors.missed) << "nobody drops corners at edges in depth here";
    EXPECT_LT(Errors::quantile(errors.distances_px, 0.95), 0.6);
    EXPECT_LT(Errors::quantile(errors.distances_px, 0.5), 0.12);
    EXPECT_LT(Errors::quantile(errors.distances_px, 2.0 / 3.0), 0.2);
    EXPECT_LT(Errors::quantile(errors.nis, 0.5), 1.4) << "the median of chi-square";
  }
}

TEST(TrackerInARoom, FindsPlacesToAFifthOfAPixelUnderKnownMotion) { expect_right_places(Room::calm()); }

TEST(TrackerInARoom, DoesSoWhereLightChanges) {
  sim::CameraSimulatorOptions camera_simulator = Room::calm();
  camera_simulator.drift_ratio = 0.1;
  camera_simulator.jump_ratio = 0.25;
  camera_simulator.jump_interval_s = 1.0;
  expect_right_places(camera_simulator);
}

TEST(TrackerInARoom, RecognisesFourOfFiveWhereItIsLessStrict) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    Room room(seed, Room::calm());
    const Errors errors = follow(room, 90, 3, 9.0 * Eigen::Matrix2d::Identity(), {.accept_ratio = 4.0});
    EXPECT_GT(errors.found, 3 * errors.missed) << seed;
  }
}

/// Variance per axis of the difference of two errors of one landmark between whose views there are so many
/// degrees; matches of something else left out.
double variance_of_differences(const std::vector<Errors>& runs, double from_deg, double to_deg) {
  constexpr double kSomethingElse_px = 2.0;
  double sum = 0.0;
  int count = 0;
  for (const Errors& errors : runs) {
    for (const auto& [id, seen] : errors.matches) {
      for (std::size_t i = 0; i < seen.size(); ++i) {
        for (std::size_t j = i + 1; j < seen.size(); ++j) {
          const double cosine = seen[i].view_m.normalized().dot(seen[j].view_m.normalized());
          const double angle_deg = to_degrees(std::acos(std::min(1.0, cosine)));
          const Vector2d difference = seen[i].error_px - seen[j].error_px;
          if (angle_deg < from_deg || angle_deg > to_deg || difference.norm() > kSomethingElse_px) continue;
          sum += 0.5 * difference.squaredNorm();
          ++count;
        }
      }
    }
  }
  EXPECT_GT(count, 100);
  return sum / count;
}

/// What ekf/pixel_slam.hpp takes for granted: PixelSlamOptions::landmark_noise_px.
TEST(TrackerInARoom, PlacesDriftAsTheViewTurns) {
  std::vector<Errors> runs;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    Room room(seed, Room::calm());
    runs.push_back(follow(room, 180, 3, 9.0 * Eigen::Matrix2d::Identity()));
  }
  const double still = variance_of_differences(runs, 0.0, 0.3);
  const double at_1_deg = variance_of_differences(runs, 0.7, 1.4);
  const double at_10_deg = variance_of_differences(runs, 7.0, 14.0);
  std::printf("differences of errors, px: %.3f from one place, %.3f at 1 deg, %.3f at 10 deg\n",
              std::sqrt(still), std::sqrt(at_1_deg), std::sqrt(at_10_deg));
  EXPECT_LT(still, 0.1 * 0.1);
  EXPECT_GT(at_1_deg, 1.5 * still);
  EXPECT_GT(at_10_deg, 2.0 * at_1_deg);
}

}  // namespace
}  // namespace waymark::vision
