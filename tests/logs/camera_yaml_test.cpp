#include "workbench/logs/camera_yaml.hpp"

#include <gmock/gmock.h>

namespace waymark {
namespace {

using testing::HasSubstr;

// As camera_calibration of ROS writes it.
const std::string kRosFile = R"(image_width: 640
image_height: 480
camera_name: narrow_stereo
camera_matrix:
  rows: 3
  cols: 3
  data: [ 438.78336,   0.     , 305.59334,
            0.     , 437.30257, 243.73835,
            0.     ,   0.     ,   1.     ]
distortion_model: plumb_bob
distortion_coefficients:
  rows: 1
  cols: 5
  data: [-0.361976, 0.11051, 0.001014, 0.000505, 0.]
rectification_matrix:
  rows: 3
  cols: 3
  data: [1, 0, 0, 0, 1, 0, 0, 0, 1]
projection_matrix:
  rows: 3
  cols: 4
  data: [393.6, 0, 300.5, 0, 0, 403.9, 241.8, 0, 0, 0, 1, 0]
)";

TEST(CameraYaml, ReadsWhatRosWrites) {
  const auto camera = parse_camera_yaml(kRosFile, "camera.yaml");
  ASSERT_TRUE(camera.ok()) << camera.error().message;
  EXPECT_EQ(camera->width_px, 640);
  EXPECT_EQ(camera->height_px, 480);
  EXPECT_EQ(camera->fu_px, 438.78336);
  EXPECT_EQ(camera->fv_px, 437.30257);
  EXPECT_EQ(camera->cu_px, 305.59334);
  EXPECT_EQ(camera->cv_px, 243.73835);
  EXPECT_EQ(camera->distortion.k1, -0.361976);
  EXPECT_EQ(camera->distortion.k2, 0.11051);
  EXPECT_EQ(camera->distortion.p1, 0.001014);
  EXPECT_EQ(camera->distortion.p2, 0.000505);
  EXPECT_EQ(camera->distortion.k3, 0.0);
}

TEST(CameraYaml, WhatIsWrittenIsReadToTheLastBit) {
  CameraOptions camera{.width_px = 100, .height_px = 50, .fu_px = 100.0 / 3.0, .fv_px = 277.128129211};
  camera.cu_px = 1.0 / 7.0;
  camera.distortion = {-1.0 / 3.0, 2e-17, 0.1 + 0.2, -5.0, 1e300};
  const auto read = parse_camera_yaml(to_camera_yaml(camera, "front"), "camera.yaml");
  ASSERT_TRUE(read.ok()) << read.error().message;
  EXPECT_EQ(lens_settings(*read), lens_settings(camera));
}

TEST(CameraYaml, SettingsAreTheKeysOfTheCameraButForItsMount) {
  CameraOptions camera;
  camera.fu_px = 123.5;
  std::map<std::string, std::string> settings;
  for (const auto& [key, value] : lens_settings(camera)) settings[key] = value;
  EXPECT_EQ(settings.at("camera.fu_px"), "123.5");
  EXPECT_FALSE(settings.contains("camera.mount_z_m"));
  settings["camera.mount_z_m"] = "1";
  const auto taken = take_lens(settings);
  ASSERT_TRUE(taken);
  EXPECT_EQ(taken->fu_px, 123.5);
  EXPECT_EQ(settings.size(), 1u);
  EXPECT_FALSE(take_lens(settings));
  EXPECT_EQ(settings.size(), 1u);
}

struct YamlDamage {
  std::string text;  ///< of the file
  std::string replacement;
  std::string complaint;
};

class DamagedCameraYaml : public testing::TestWithParam<YamlDamage> {};

TEST_P(DamagedCameraYaml, IsRefusedWithItsLine) {
  const auto& [text, replacement, complaint] = GetParam();
  std::string yaml = kRosFile;
  ASSERT_NE(yaml.find(text), std::string::npos);
  yaml.replace(yaml.find(text), text.size(), replacement);
  const auto camera = parse_camera_yaml(yaml, "camera.yaml");
  ASSERT_FALSE(camera.ok());
  EXPECT_THAT(camera.error().message, HasSubstr(complaint));
}

INSTANTIATE_TEST_SUITE_P(
    All, DamagedCameraYaml,
    testing::Values(
        YamlDamage{"image_width: 640\n", "", "camera.yaml: image_width is missing"},
        YamlDamage{"image_height: 480", "image_height: -3", "camera.yaml:2: image_height must be"},
        YamlDamage{"image_height: 480", "image_height: [4]", "camera.yaml:2: image_height must be"},
        YamlDamage{"plumb_bob", "equidistant", "camera.yaml:10: distortion_model"},
        YamlDamage{"438.78336", "wide",
                   "camera.yaml:7: camera_matrix contains something that is not a number"},
        YamlDamage{"438.78336", "-438", "camera_matrix must be [fx, 0, cx"},
        YamlDamage{"438.78336", ".nan", "camera_matrix contains something that is not a number"},
        YamlDamage{", 0.000505, 0.]", "]", "camera.yaml:12: distortion_coefficients needs data"},
        YamlDamage{"camera_matrix:\n", "camera_matrix: {}\nx:\n",
                   "camera_matrix needs data: [...] with 9 numbers"},
        YamlDamage{"data: [-0.361976", "data: [[-0.361976", "camera.yaml:"}));

TEST(CameraYaml, RefusesWhatIsNoMap) {
  EXPECT_THAT(parse_camera_yaml("- 1\n- 2\n", "c.yaml").error().message,
              HasSubstr("c.yaml:1: expected lines"));
  EXPECT_THAT(parse_camera_yaml("", "c.yaml").error().message, HasSubstr("c.yaml:1: expected lines"));
  EXPECT_FALSE(read_camera_yaml("/nowhere/camera.yaml").ok());
}

TEST(CameraYaml, RefusesWhatUnfoldsWithoutEnd) {
  std::string yaml = "l0: &l0 {}\n";
  for (int level = 1; level < 15; ++level) {
    const std::string before = std::to_string(level - 1);
    yaml += "l" + std::to_string(level) + ": &l" + std::to_string(level) + " [";
    for (int i = 0; i < 10; ++i) yaml += "*l" + before + ", ";
    yaml += "]\n";
  }
  EXPECT_THAT(parse_camera_yaml(yaml, "c.yaml").error().message, HasSubstr("too many values"));
}

}  // namespace
}  // namespace waymark
