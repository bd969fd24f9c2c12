#include "workbench/datasets/planar_mono_slam.hpp"

#include <cmath>
#include <map>
#include <string>

#include <gmock/gmock.h>

#include "support/data_dir.hpp"
#include "support/io_support.hpp"
#include "waymark/models/camera.hpp"

#include "workbench/config/robot_keys.hpp"

namespace waymark {
namespace {

using test::only;
using test::TempFolder;
using testing::HasSubstr;

constexpr PixelNoise kNoNoise{.sigma_px = 0.0};

constexpr const char* kCamera =
    "camera matrix:\n180   0 320\n  0 170 240\n  0   0   1\n"
    "cam_transform:\n  0   0   1 0.2\n -1   0   0   0.1\n  0  -1   0   0.3\n  0   0   0   1\n"
    "z_near: 0\nz_far:  5\nwidth:  640\nheight: 480\n";
constexpr const char* kPoints =
    "seq: 0\ngt_pose: 0 0 0\nodom_pose: 0.5 0 0 \npoint 0 7 100.5 200.25 \npoint 1 9 3 4 \n";

/// A log of one step that is whole.
void write_log(const TempFolder& folder) {
  folder.write("camera.dat", kCamera);
  folder.write("world.dat", "7 1 2 3\n9 4 5 6\n");
  folder.write("trajectory.dat", "0 0.5 0.25 0.125 1 2 4\n");
  folder.write("meas-00000.dat", kPoints);
}

std::string error_of(const TempFolder& folder) {
  const auto source = open_planar_mono_slam(folder.path(), kNoNoise);
  return source ? "" : source.error().message;
}

/// The error of a log with one file that reads otherwise.
std::string error_with(const char* file, const std::string& content) {
  const TempFolder folder;
  write_log(folder);
  folder.write(file, content);
  return error_of(folder);
}

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  return text.replace(text.find(what), what.size(), by);
}

std::map<std::string, std::string> settings_of(const Source& source) {
  std::map<std::string, std::string> settings;
  for (const auto& [key, value] : source.info().settings) settings[key] = value;
  return settings;
}

TEST(PlanarMonoSlam, ReadsPathPointsLandmarksAndCamera) {
  const TempFolder folder;
  write_log(folder);
  EXPECT_TRUE(is_planar_mono_slam(folder.path()));
  const auto source = open_planar_mono_slam(folder.path(), kNoNoise).value();
  const auto events = test::read_all(*source).events;
  EXPECT_EQ(only<OdometryPose>(events).at(0).second.T_odom_robot.y_m, 0.25);
  EXPECT_EQ(only<Truth>(events).at(0).second.y_m, 2.0);
  EXPECT_NEAR(*only<Truth>(events).at(0).second.theta_rad, 4.0 - 2.0 * M_PI, 1e-15);
  const auto points = only<Observations>(events).at(0).second;
  ASSERT_EQ(points.size(), 2U);
  EXPECT_EQ(points[0].id->number, 7);
  EXPECT_EQ(std::get<Pixel>(points[0].value).v_px, 200.25);
  ASSERT_EQ(source->info().landmarks.size(), 2U);
  EXPECT_EQ(source->info().landmarks[1].z_m, 6.0);
  EXPECT_TRUE(source->info().only_pixels);
  auto settings = settings_of(*source);
  EXPECT_EQ(settings["camera.fv_px"], "170");
  EXPECT_EQ(settings["camera.cu_px"], "320");
  EXPECT_EQ(settings["camera.height_px"], "480");
  EXPECT_EQ(settings["pixel.farthest_m"], "5");
  EXPECT_TRUE(source->notes().empty());
}

TEST(PlanarMonoSlam, StepsAreAFifthOfASecondApart) {
  const TempFolder folder;
  write_log(folder);
  folder.write("trajectory.dat", "0 0 0 0 0 0 0\n3 0 0 0 0 0 0\n");
  folder.write("meas-00003.dat", replaced(kPoints, "seq: 0", "seq: 3"));
  const auto source = open_planar_mono_slam(folder.path(), kNoNoise).value();
  EXPECT_EQ(only<Observations>(test::read_all(*source).events).at(1).first, stamp_from_seconds(0.6));
}

TEST(PlanarMonoSlam, TheMountIsTheTransformOfTheCameraFile) {
  const CameraMount mount{
      .x_m = 0.1, .y_m = -0.2, .z_m = 0.3, .roll_deg = 10, .pitch_deg = 20, .yaw_deg = 30};
  const Eigen::Matrix3d R = mount.R_robot_camera();
  std::string camera = "camera matrix:\n180 0 320\n0 180 240\n0 0 1\ncam_transform:\n";
  for (int row = 0; row < 3; ++row)
    camera += std::to_string(R(row, 0)) + " " + std::to_string(R(row, 1)) + " " + std::to_string(R(row, 2)) +
              " " + std::to_string(mount.p_robot_camera()[row]) + "\n";
  const TempFolder folder;
  write_log(folder);
  folder.write("camera.dat", camera + "0 0 0 1\nz_near: 0\nz_far: 5\nwidth: 640\nheight: 480\n");
  auto settings = settings_of(*open_planar_mono_slam(folder.path(), kNoNoise).value());
  EXPECT_NEAR(std::stod(settings["camera.mount_roll_deg"]), 10.0, 1e-3);
  EXPECT_NEAR(std::stod(settings["camera.mount_pitch_deg"]), 20.0, 1e-3);
  EXPECT_NEAR(std::stod(settings["camera.mount_yaw_deg"]), 30.0, 1e-3);
  EXPECT_NEAR(std::stod(settings["camera.mount_y_m"]), -0.2, 1e-9);
}

TEST(PlanarMonoSlam, NoiseIsThatOfItsSeedAndIsNamed) {
  const TempFolder folder;
  write_log(folder);
  const auto first_u = [&folder](const PixelNoise& noise) {
    const auto source = open_planar_mono_slam(folder.path(), noise).value();
    const auto points = only<Observations>(test::read_all(*source).events).at(0).second;
    return std::get<Pixel>(points[0].value).u_px;
  };
  EXPECT_NE(first_u({1.0, 1}), 100.5);
  EXPECT_EQ(first_u({1.0, 1}), first_u({1.0, 1}));
  EXPECT_NE(first_u({1.0, 1}), first_u({1.0, 2}));
  EXPECT_DOUBLE_EQ(first_u({2.0, 1}) - 100.5, 2.0 * (first_u({1.0, 1}) - 100.5));
  const auto source = open_planar_mono_slam(folder.path(), {2.0, 1}).value();
  EXPECT_THAT(source->notes().at(0), HasSubstr("noise of 2 px"));
  EXPECT_EQ(settings_of(*source)["pixel.sigma_px"], "2");
}

TEST(PlanarMonoSlam, FilesThatAreMissingAreNamed) {
  const TempFolder folder;
  write_log(folder);
  std::filesystem::remove(folder.path() / "meas-00000.dat");
  EXPECT_THAT(error_of(folder), HasSubstr("trajectory.dat:1: meas-00000.dat of this step is missing"));
  std::filesystem::remove(folder.path() / "world.dat");
  EXPECT_FALSE(is_planar_mono_slam(folder.path()));
}

TEST(PlanarMonoSlam, BadLinesAreNamed) {
  EXPECT_THAT(error_with("trajectory.dat", "0 0.5 0.25 0.125 1 2\n"), HasSubstr(":1: expected 7 columns"));
  EXPECT_THAT(error_with("trajectory.dat", "0 0 0 nan 0 0 0\n"),
              HasSubstr(":1: 'nan' is not a finite number"));
  EXPECT_THAT(error_with("trajectory.dat", "0 0 0 0 0 0 0\n0 0 0 0 0 0 0\n"),
              HasSubstr(":2: step 0 must be"));
  EXPECT_THAT(error_with("world.dat", "7 1 2\n"), HasSubstr("world.dat:1: expected 4 columns"));
  const std::string points = kPoints;
  EXPECT_THAT(error_with("meas-00000.dat", points + "point 2 11 5"),
              HasSubstr(":6: expected point INDEX WORLD_ID COL ROW, found 3 numbers (the file is cut off"));
  EXPECT_THAT(error_with("meas-00000.dat", points + "point 2 11 nan 4\n"), HasSubstr(":6: 'nan' is not"));
  EXPECT_THAT(error_with("meas-00000.dat", points + "point 2 -1 3 4\n"), HasSubstr(":6: WORLD_ID must be"));
  EXPECT_THAT(error_with("meas-00000.dat", points + "pixel 2 1 3 4\n"), HasSubstr(":6: expected point"));
  EXPECT_THAT(error_with("meas-00000.dat", ""), HasSubstr("meas-00000.dat:0: expected a line `seq:`"));
  EXPECT_THAT(error_with("meas-00000.dat", replaced(points, "seq: 0", "seq: 5")),
              HasSubstr(":1: belongs to step 5"));
  EXPECT_THAT(error_with("meas-00000.dat", replaced(points, "0.5 0 0", "0.5 0")),
              HasSubstr(":3: expected x, y"));
}

TEST(PlanarMonoSlam, BadCamerasAreNamed) {
  const auto error_of_camera = [](const std::string& what, const std::string& by) {
    return error_with("camera.dat", replaced(kCamera, what, by));
  };
  EXPECT_THAT(error_of_camera("camera matrix:", "\x01\x02"),
              HasSubstr("camera.dat:1: expected a line `camera"));
  EXPECT_THAT(error_of_camera("180   0 320", "180 0"), HasSubstr(":2: expected a row of 3 numbers"));
  EXPECT_THAT(error_of_camera("180   0 320", "-180 0 320"), HasSubstr(":4: the camera matrix must be"));
  EXPECT_THAT(error_of_camera("  0   0   1 0.2", "  0   0   2 0.2"), HasSubstr(":9: cam_transform must be"));
  EXPECT_THAT(error_of_camera("z_far:  5", "z_far:  inf"), HasSubstr(":11: 'inf' is not a finite number"));
  EXPECT_THAT(error_of_camera("width:  640", "width:  0"), HasSubstr(":12: width: must be above 0"));
  EXPECT_THAT(error_of_camera("height: 480\n", ""), HasSubstr("expected a line `height:`"));
}

TEST(PlanarMonoSlam, RecordingHoldsTheKnownCounts) {
  WAYMARK_REQUIRE_DATA("planar-mono-slam");
  const auto source = open_planar_mono_slam(test::data_path("planar-mono-slam"), kNoNoise);
  ASSERT_TRUE(source.ok()) << source.error().message;
  const auto events = test::read_all(**source).events;
  EXPECT_EQ(only<OdometryPose>(events).size(), 200U);
  EXPECT_EQ(only<Truth>(events).size(), 200U);
  EXPECT_EQ((*source)->info().landmarks.size(), 1000U);
  EXPECT_NEAR(static_cast<double>(test::count_observations(events)) / 200.0, 98.0, 0.5);
}

TEST(PlanarMonoSlam, PointsLieWhereTheCameraSeesTheSurvey) {
  WAYMARK_REQUIRE_DATA("planar-mono-slam");
  const auto source = open_planar_mono_slam(test::data_path("planar-mono-slam"), kNoNoise).value();
  CameraOptions options;
  Schema schema;
  describe(schema, options);
  for (const auto& [key, value] : source->info().settings) {
    if (schema.has(key)) {
      ASSERT_TRUE(schema.set(key, value, "test").ok());
    }
  }
  const Camera camera(options);
  std::map<LandmarkId, Eigen::Vector3d> survey;
  for (const TrueLandmark& l : source->info().landmarks) survey[l.id] = {l.x_m, l.y_m, l.z_m};
  const auto events = test::read_all(*source).events;
  const auto truth = only<Truth>(events);
  const auto points = only<Observations>(events);
  double worst_px = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Truth& at = truth[i].second;
    const CameraPose pose = camera.pose({at.x_m, at.y_m, *at.theta_rad});
    for (const Observation& point : points[i].second) {
      const auto [u_px, v_px] = std::get<Pixel>(point.value);
      const auto seen = camera.project(pose.R_camera_world * (survey.at(*point.id) - pose.p_world_camera));
      ASSERT_TRUE(seen.has_value());
      worst_px = std::max(worst_px, (seen->pixel - Eigen::Vector2d(u_px, v_px)).norm());
    }
  }
  EXPECT_LT(worst_px, 0.2);
}

}  // namespace
}  // namespace waymark
