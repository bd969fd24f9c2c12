#include "workbench/bags/bag_options.hpp"

namespace waymark {

void describe(Schema& schema, BagOptions& o) {
  schema.text("input.odometry_topic", o.odometry_topic,
              "topic of a bag that says how the robot moved; empty: the one whose type says most; none: none",
              Shown::kAlways);
  schema.text("input.observation_topic", o.observation_topic,
              "topic of detected markers; empty: the one with most messages; none: none", Shown::kAlways);
  schema.text("input.image_topic", o.image_topic,
              "topic of images; empty: the one with most messages; none: none", Shown::kAlways);
  schema.text("input.camera_info_topic", o.camera_info_topic,
              "topic that describes the camera; empty: the one beside the images; none: none");
  schema.text("input.truth_topic", o.truth_topic, "topic of the robot's true poses; empty or none: none",
              Shown::kAlways);
  schema.text("input.left_joint", o.left_joint,
              "joint of the left wheel in a JointState; empty: the first with left and wheel in its name");
  schema.text("input.right_joint", o.right_joint, "... of the right wheel");
  schema.text("input.camera_file", o.camera_file,
              "a ROS camera_info YAML file that describes the camera of a bag, instead of what the bag says",
              Shown::kAlways);
  schema.choice("input.stamps", o.stamps, {"header", "recorded"},
                "time of a message: of its header, or when it was recorded (for clocks that disagree)");
}

}  // namespace waymark
