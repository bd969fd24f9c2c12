#include "workbench/logs/log_folder.hpp"

#include <gmock/gmock.h>

#include "support/data_dir.hpp"
#include "support/io_support.hpp"

#include "workbench/logs/camera_yaml.hpp"
#include "workbench/logs/image_file.hpp"

namespace waymark {
namespace {

using test::only;
using test::TempFolder;
using testing::HasSubstr;

constexpr const char* kVersionLine = "waymark_log: 1\n";

/// The events of a folder with log.yaml and one further file, or the error of opening or reading it.
test::Delivered read_with(std::string_view file, std::string_view content,
                          std::string_view yaml = kVersionLine) {
  const TempFolder folder;
  folder.write("log.yaml", yaml);
  if (!file.empty()) folder.write(file, content);
  auto log = open_log_folder(folder.path());
  if (!log) return {{}, log.error().message};
  return test::read_all(**log);
}

std::string error_of_yaml(std::string_view yaml) { return read_with("", "", yaml).error; }

Observations read_observations(std::string_view rows,
                               std::string_view header = "stamp_s,id,range_m,bearing_rad") {
  const auto delivered = read_with("observations.csv", std::string(header) + "\n" + std::string(rows));
  EXPECT_EQ(delivered.error, "");
  const auto found = only<Observations>(delivered.events);
  return found.empty() ? Observations{} : found.front().second;
}

TEST(LogFolder, ReadsEveryKindOfOdometry) {
  const auto wheels =
      only<WheelAngles>(read_with("wheels.csv", "stamp_s,left_rad,right_rad\n1,2,3\n").events);
  ASSERT_EQ(wheels.size(), 1U);
  EXPECT_EQ(wheels[0].first, Stamp{std::chrono::seconds(1)});
  EXPECT_EQ(wheels[0].second.left_rad, 2.0);
  EXPECT_EQ(wheels[0].second.right_rad, 3.0);
  const auto velocity = only<Velocity>(read_with("velocity.csv", "stamp_s,v_mps,w_radps\n1,2,3\n").events);
  ASSERT_EQ(velocity.size(), 1U);
  EXPECT_EQ(velocity[0].second.w_radps, 3.0);
  const auto steering = only<Steering>(read_with("steering.csv", "stamp_s,v_mps,steer_rad\n1,2,3\n").events);
  ASSERT_EQ(steering.size(), 1U);
  EXPECT_EQ(steering[0].second.steer_rad, 3.0);
  const auto poses =
      only<OdometryPose>(read_with("odometry.csv", "stamp_s,x_m,y_m,theta_rad\n1,2,3,4\n").events);
  ASSERT_EQ(poses.size(), 1U);
  EXPECT_EQ(poses[0].second.T_odom_robot, (Pose2{2.0, 3.0, 4.0}));
}

TEST(LogFolder, ReadsAGyroBesideTheOdometry) {
  const auto rates = only<YawRate>(read_with("imu.csv", "stamp_s,w_radps\n1,0.25\n").events);
  ASSERT_EQ(rates.size(), 1U);
  EXPECT_EQ(rates[0].first, Stamp{std::chrono::seconds(1)});
  EXPECT_EQ(rates[0].second.w_radps, 0.25);
}

TEST(LogFolder, EmptyCellsDecideWhatWasMeasured) {
  const auto seen = read_observations("1,7,2.5,0.5\n1,,2.5,\n1,8,,0.25\n");
  ASSERT_EQ(seen.size(), 3U);
  EXPECT_EQ(seen[0].id, (LandmarkId{LandmarkId::Family::kMarker, 7}));
  EXPECT_EQ(std::get<RangeBearing>(seen[0].value).bearing_rad, 0.5);
  EXPECT_EQ(seen[1].id, std::nullopt);
  EXPECT_EQ(std::get<Range>(seen[1].value).range_m, 2.5);
  EXPECT_EQ(std::get<Bearing>(seen[2].value).bearing_rad, 0.25);
}

TEST(LogFolder, IdsMayBeWrittenAsOtherNumbers) {
  const Observations observed = read_observations("1,3.0,2,0.5\n1,,2,0.5\n");
  ASSERT_EQ(observed.size(), 2U);
  EXPECT_EQ(observed[0].id, (LandmarkId{LandmarkId::Family::kMarker, 3}));
  EXPECT_FALSE(observed[1].id);
}

TEST(LogFolder, ABagBesideItsFilesIsNamedAndNotRead) {
  const TempFolder folder;
  folder.write("log.yaml", kVersionLine);
  folder.write("notes.db3", "SQLite format 3");
  folder.write("drive_0.mcap", "");
  EXPECT_TRUE(names_log_folder(folder.path()));
  const auto log = open_log_folder(folder.path());
  ASSERT_TRUE(log) << log.error().message;
  EXPECT_THAT((*log)->notes(), testing::ElementsAre(HasSubstr(
                                   "log.yaml says that this is a log folder: drive_0.mcap and notes.db3 "
                                   "in it are not read")));
}

TEST(LogFolder, AnotherProgramsLogYamlNamesNoLogFolder) {
  const TempFolder folder;
  EXPECT_FALSE(names_log_folder(folder.path()));
  folder.write("log.yaml", "level: debug\n");
  EXPECT_FALSE(names_log_folder(folder.path()));
}

TEST(LogFolder, SaysWhetherAnyObservationHasAnIdentity) {
  const std::string head = "stamp_s,id,range_m,bearing_rad\n";
  const auto has_identities = [&](const std::string& rows) {
    const TempFolder folder;
    folder.write("log.yaml", kVersionLine);
    folder.write("observations.csv", head + rows);
    const auto log = open_log_folder(folder.path());
    return log.ok() && (*log)->info().identities;
  };
  EXPECT_TRUE(has_identities("1,,2,0\n2,7,2,0\n"));
  EXPECT_FALSE(has_identities("1,,2,0\n2,,2,0\n"));
  EXPECT_TRUE(has_identities("1,,,\n")) << "nothing was seen";
  EXPECT_TRUE(has_identities(""));
}

TEST(LogFolder, ReadsPixelsAloneOrBesideRanges) {
  const auto pixels = read_observations("1,3,320.5,-1\n", "stamp_s,id,u_px,v_px");
  ASSERT_EQ(pixels.size(), 1U);
  EXPECT_EQ(std::get<Pixel>(pixels[0].value).u_px, 320.5);
  const auto mixed = read_observations("1,3,,,5,6\n1,4,2,,,\n", "stamp_s,id,range_m,bearing_rad,u_px,v_px");
  ASSERT_EQ(mixed.size(), 2U);
  EXPECT_TRUE(std::holds_alternative<Pixel>(mixed[0].value));
  EXPECT_TRUE(std::holds_alternative<Range>(mixed[1].value));
}

TEST(LogFolder, RowWithoutIdAndMeasurementIsALookThatSawNothing) {
  const auto delivered = read_with("observations.csv", "stamp_s,id,range_m,bearing_rad\n1,,,\n");
  ASSERT_EQ(delivered.events.size(), 1U);
  EXPECT_TRUE(std::get<Observations>(delivered.events[0].content).empty());
}

TEST(LogFolder, TruthMayLackHeadings) {
  const auto cells =
      only<Truth>(read_with("truth.csv", "stamp_s,x_m,y_m,theta_rad\n1,2,3,\n2,2,3,4\n").events);
  ASSERT_EQ(cells.size(), 2U);
  EXPECT_EQ(cells[0].second.theta_rad, std::nullopt);
  EXPECT_EQ(cells[1].second.theta_rad, 4.0);
  EXPECT_EQ(only<Truth>(read_with("truth.csv", "stamp_s,x_m,y_m\n1,2,3\n").events).size(), 1U);
}

TEST(LogFolder, AtEqualStampsOdometryComesBeforeTruthBeforeObservations) {
  const TempFolder folder;
  folder.write("log.yaml", kVersionLine);
  folder.write("observations.csv", "stamp_s,id,range_m\n1,1,1\n");
  folder.write("truth.csv", "stamp_s,x_m,y_m\n1,0,0\n");
  folder.write("wheels.csv", "stamp_s,left_rad,right_rad\n1,0,0\n2,0,0\n");
  const auto log = open_log_folder(folder.path());
  ASSERT_TRUE(log.ok());
  const auto events = test::read_all(**log).events;
  ASSERT_EQ(events.size(), 4U);
  EXPECT_TRUE(std::holds_alternative<WheelAngles>(events[0].content));
  EXPECT_TRUE(std::holds_alternative<Truth>(events[1].content));
  EXPECT_TRUE(std::holds_alternative<Observations>(events[2].content));
}

TEST(LogFolder, ImagesAreNamedByTheirPathAndNotRead) {
  const TempFolder folder;
  folder.write("log.yaml", kVersionLine);
  folder.write("images.csv", "stamp_s,file\n1,a.png\n");
  const auto image = folder.write("images/a.png", "x");
  const auto log = open_log_folder(folder.path());
  ASSERT_TRUE(log.ok());
  const auto images = test::only<Image>(test::read_all(**log).events);
  ASSERT_EQ(images.size(), 1U);
  EXPECT_EQ(images[0].second.file, image.string());
  EXPECT_EQ(images[0].second.pixels, nullptr);
}

TEST(LogFolder, LostAndRepeatedImagesAreSkippedAndCounted) {
  const TempFolder folder;
  folder.write("log.yaml", kVersionLine);
  folder.write("images.csv", "stamp_s,file\n1,a.png\n1,a.png\n2,none.png\n3,a.png\n4,none.png\n");
  folder.write("images/a.png", "x");
  const auto log = open_log_folder(folder.path());
  ASSERT_TRUE(log.ok());
  const auto delivered = test::read_all(**log);
  EXPECT_EQ(delivered.error, "");
  EXPECT_EQ(delivered.events.size(), 2U);
  EXPECT_THAT((*log)->notes(), testing::UnorderedElementsAre(
                                   "images skipped with the same stamp as the one before: 1",
                                   "images skipped that are listed in images.csv and missing in images/: 2"));
}

TEST(LogFolder, AnImageWithoutAFileIsAnError) {
  const TempFolder folder;
  folder.write("log.yaml", kVersionLine);
  folder.write("images.csv", "stamp_s,file\n1,\n");
  const auto log = open_log_folder(folder.path());
  ASSERT_TRUE(log.ok());
  EXPECT_THAT(test::read_all(**log).error, HasSubstr("images.csv:2: column file is empty"));
}

std::string value_of(const LogInfo& info, std::string_view key) {
  std::string last;
  for (const auto& [name, value] : info.settings)
    if (name == key) last = value;
  return last;
}

TEST(LogFolder, CameraComesFromCameraYamlAndItsMountFromLogYaml) {
  const TempFolder folder;
  folder.write("log.yaml", std::string(kVersionLine) + "camera_mount: {x_m: 0.1, z_m: 0.4, pitch_deg: 5}\n");
  folder.write("camera.yaml", to_camera_yaml({.width_px = 640, .height_px = 480, .fu_px = 500.25}, "front"));
  const auto log = open_log_folder(folder.path());
  ASSERT_TRUE(log.ok());
  const LogInfo& info = (*log)->info();
  EXPECT_EQ(value_of(info, "camera.width_px"), "640");
  EXPECT_EQ(value_of(info, "camera.fu_px"), "500.25");
  EXPECT_EQ(value_of(info, "camera.mount_z_m"), "0.4");
  EXPECT_EQ(value_of(info, "camera.mount_pitch_deg"), "5");
  EXPECT_EQ(value_of(info, "camera.mount_roll_deg"), "");
}

TEST(LogFolder, RefusesACameraThatContradictsTheImages) {
  const TempFolder folder;
  folder.write("log.yaml", kVersionLine);
  folder.write("images.csv", "stamp_s,file\n1,none.png\n2,a.png\n");
  folder.write("camera.yaml", to_camera_yaml({.width_px = 640, .height_px = 480}, "front"));
  folder.write("images/none.txt", "");
  ASSERT_TRUE(write_png(folder.path() / "images/a.png", GreyImage(320, 240)).ok());
  const auto log = open_log_folder(folder.path());
  ASSERT_FALSE(log.ok());
  EXPECT_THAT(log.error().message,
              testing::AllOf(HasSubstr("camera.yaml: image_width and image_height are 640 and 480"),
                             HasSubstr("a.png has 320 x 240 pixels")));
}

TEST(LogFolder, InfoComesFromLogYamlAndLandmarks) {
  const TempFolder folder;
  folder.write("log.yaml",
               "waymark_log: 1\nname: a loop\nwheels: {left_radius_m: 0.1, track_m: 0.3}\nlandmark_sensor:\n "
               " x_m: 0.05\n"
               "  yaw_deg: 90\ntruth_sensor: {x_m: -3.9, y_m: 0.6}\nnoise: {range_sigma_m: 0.2}\n"
               "camera_mount: {z_m: 0.3, pitch_deg: 5}\nconfig: {sensor: {range_sigma_m: 0.4}, "
               "motion.turn_scale: 1.1}\n");
  folder.write("landmarks.csv",
               "\xEF\xBB\xBF"
               "id,x_m,y_m\r\n4,1,2\r\n5,3,4");
  const auto log = open_log_folder(folder.path());
  ASSERT_TRUE(log.ok()) << log.error().message;
  const LogInfo& info = (*log)->info();
  EXPECT_EQ(info.name, "a loop");
  EXPECT_EQ(info.format, "log folder");
  const std::vector<std::pair<std::string, std::string>> settings{
      {"wheels.left_radius_m", "0.1"}, {"wheels.track_m", "0.3"},       {"sensor.x_m", "0.05"},
      {"sensor.yaw_deg", "90"},        {"sensor.range_sigma_m", "0.2"}, {"camera.mount_z_m", "0.3"},
      {"camera.mount_pitch_deg", "5"}, {"sensor.range_sigma_m", "0.4"}, {"motion.turn_scale", "1.1"}};
  EXPECT_EQ(info.settings, settings);
  EXPECT_EQ(info.truth_sensor_m, Eigen::Vector2d(-3.9, 0.6));
  ASSERT_EQ(info.landmarks.size(), 2U);
  EXPECT_EQ(info.landmarks[1].id, (LandmarkId{LandmarkId::Family::kMarker, 5}));
  EXPECT_EQ(info.landmarks[1].y_m, 4.0);
}

TEST(LogFolder, NameIsThatOfTheFolderWhereNoneIsGiven) {
  const TempFolder folder;
  folder.write("log.yaml", kVersionLine);
  EXPECT_EQ(open_log_folder(folder.path()).value()->info().name, folder.path().filename().string());
}

TEST(LogFolder, BadLogYamlIsAnErrorWithItsLine) {
  EXPECT_THAT(error_of_yaml("name: x\n"), HasSubstr("log.yaml: the line `waymark_log: 1` is missing"));
  EXPECT_THAT(error_of_yaml(""), HasSubstr("`waymark_log: 1` is missing"));
  EXPECT_THAT(error_of_yaml("waymark_log: 2\n"),
              HasSubstr("log.yaml:1: waymark_log: '2' is not a supported version"));
  EXPECT_THAT(error_of_yaml("waymark_log: 1\nwheels:\n  trak_m: 1\n"),
              HasSubstr("log.yaml:3: unknown key wheels.trak_m, did you mean wheels.track_m?"));
  EXPECT_THAT(error_of_yaml("waymark_log: 1\nwheels: {track_m: wide}\n"),
              HasSubstr("log.yaml:2: wheels.track_m: 'wide' is not a number"));
  EXPECT_THAT(error_of_yaml("waymark_log: 1\ncamera_mount: {z_m: nan}\n"),
              HasSubstr("camera_mount.z_m: 'nan'"));
  EXPECT_THAT(error_of_yaml("waymark_log: 1\nwheels: [1, 2]\n"),
              HasSubstr("log.yaml:2: wheels cannot be a list"));
  EXPECT_THAT(error_of_yaml("waymark_log: 1\n\x01\x02: {"), HasSubstr("log.yaml:"));
}

TEST(LogFolder, MissingLogYamlIsAnErrorThatSaysWhatItNeeds) {
  const TempFolder folder;
  folder.write("wheels.csv", "stamp_s,left_rad,right_rad\n");
  EXPECT_THAT(open_log_folder(folder.path()).error().message, HasSubstr("log.yaml is missing"));
}

TEST(LogFolder, TwoKindsOfOdometryAreAnError) {
  const TempFolder folder;
  folder.write("log.yaml", kVersionLine);
  folder.write("wheels.csv", "stamp_s,left_rad,right_rad\n");
  folder.write("velocity.csv", "stamp_s,v_mps,w_radps\n");
  EXPECT_THAT(open_log_folder(folder.path()).error().message, HasSubstr("both wheels.csv and velocity.csv"));
}

struct BadFile {
  const char* file;
  const char* content;
  const char* error;
};

class BadFiles : public testing::TestWithParam<BadFile> {};

TEST_P(BadFiles, AreErrorsWithFileAndLine) {
  EXPECT_THAT(read_with(GetParam().file, GetParam().content).error, HasSubstr(GetParam().error));
}

INSTANTIATE_TEST_SUITE_P(
    LogFolder, BadFiles,
    testing::Values(
        BadFile{"wheels.csv", "", "wheels.csv: the file is empty"},
        BadFile{"wheels.csv", "stamp_s,left_rad,right_rad\n1,2,3\n2,", "wheels.csv:3: expected 3 columns"},
        BadFile{"wheels.csv", "stamp_s,left_rad,right_rad\n1,2,nan\n",
                "wheels.csv:2: 'nan' is not a finite number"},
        BadFile{"wheels.csv",
                "\x7F"
                "ELF\x02\x01",
                "wheels.csv:1: unknown column"},
        BadFile{"velocity.csv", "stamp_s,v_mps,w_radps\n2,0,0\n1,0,0\n",
                "velocity.csv:3: stamp 1.000000000 is before"},
        BadFile{"observations.csv", "stamp_s,id,range_m\n1,2,-0.5\n",
                "observations.csv:2: range_m is -0.5; a range cannot be negative"},
        BadFile{"observations.csv", "stamp_s,id,range_m,bearing_rad\n1,2,-0.5,0\n",
                "a range cannot be negative"},
        BadFile{"observations.csv", "stamp_s,id,range_m,bearing_rad\n1,2,,\n",
                "observations.csv:2: no measurement"},
        BadFile{"observations.csv", "stamp_s,id,range_m\n1,-2,1\n", "observations.csv:2: id -2 is below 0"},
        BadFile{"observations.csv", "stamp_s,id,range_m\n1,2.5,1\n",
                "'2.5' is not a whole number in column id"},
        BadFile{"observations.csv", "stamp_s,id,range_m\n1,2,inf\n",
                "'inf' is not a finite number in column range_m"},
        BadFile{"observations.csv", "stamp_s,id,u_px,v_px\n1,2,5,\n", "column v_px is empty"},
        BadFile{"observations.csv", "stamp_s,id,range_m,u_px,v_px\n1,2,3,4,5\n", "not both"},
        BadFile{"truth.csv", "stamp_s,x_m,y_m,theta_rad\n1,2,,\n", "truth.csv:2: column y_m is empty"},
        BadFile{"landmarks.csv", "id,x_m,y_m\n1,2,3\n1,4,5\n", "landmarks.csv:3: landmark 1 is listed twice"},
        BadFile{"landmarks.csv", "id,x_m,y_m\n1,2\n", "landmarks.csv:2: expected 3 columns"}));

TEST(LogFolder, ReadsTheMbotRecording) {
  WAYMARK_REQUIRE_DATA("mbot-apriltag/log-folder");
  const auto log = open_log_folder(test::data_path("mbot-apriltag/log-folder"));
  ASSERT_TRUE(log.ok()) << log.error().message;
  EXPECT_EQ((*log)->info().landmarks.size(), 8U);
  EXPECT_EQ((*log)->info().settings.size(), 6U);
  const auto delivered = test::read_all(**log);
  EXPECT_EQ(delivered.error, "");
  EXPECT_EQ(only<WheelAngles>(delivered.events).size(), 4535U);
  EXPECT_EQ(only<Observations>(delivered.events).size(), 389U + 4630U);
  EXPECT_EQ(test::count_observations(delivered.events), 389U + 2 * 4630U + 1U);
}

}  // namespace
}  // namespace waymark
