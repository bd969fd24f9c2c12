#include "workbench/bags/bag_options.hpp"

namespace waymark {

void describe(Schema& schema, BagOptions& o) {
  schema.text("input.odometry_topic", o.odometry_topic,
              "topic of a bag with the odometry; empty: chosen by message type; none: ignore",
              Shown::kAlways);
  schema.text(
      "input.imu_topic", o.imu_topic,
      "topic of a bag with an IMU, whose gyro holds the heading of the odometry; empty: chosen by name and "
      "frame; none: ignore",
      Shown::kAlways);
  schema.text("input.observation_topic", o.observation_topic,
              "topic of a bag with detected markers; empty: the one with most messages; none: ignore",
              Shown::kAlways);
  schema.text("input.image_topic", o.image_topic,
              "topic of a bag with images; empty: the one with most messages; none: ignore", Shown::kAlways);
  schema.text("input.camera_info_topic", o.camera_info_topic,
              "topic of a bag with the camera calibration (CameraInfo); empty: the one beside the images; "
              "none: ignore");
  schema.text("input.truth_topic", o.truth_topic,
              "topic of a bag with the true poses of the robot; empty or none: no ground truth",
              Shown::kAlways);
  schema.text("input.left_joint", o.left_joint,
              "name of the left wheel in JointState messages; empty: the first that contains left and wheel");
  schema.text(
      "input.right_joint", o.right_joint,
      "name of the right wheel in JointState messages; empty: the first that contains right and wheel");
  schema.text("input.camera_file", o.camera_file,
              "ROS camera_info YAML file of the camera, used instead of the calibration in the bag; empty: "
              "use the bag's",
              Shown::kAlways);
  schema.text("input.more_bags", o.more_bags,
              "further bags of the same drive, recorded by the same clock, separated by commas; set by more "
              "than one INPUT");
  schema.choice("input.stamps", o.stamps, {"header", "recorded"},
                "time of a message: from its header, or when it was recorded (for clocks that disagree)",
                Shown::kAlways);
}

}  // namespace waymark
