#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Geometry>

#include "workbench/bags/reader.hpp"

namespace waymark::bag {

inline constexpr std::string_view kTransforms = "tf2_msgs/TFMessage";
inline constexpr std::string_view kOldTransforms = "tf/tfMessage";

/// "/base_link", as old ROS wrote it, is "base_link".
[[nodiscard]] std::string plain_frame(std::string_view frame);

/// The tree of frames that transforms on /tf_static and /tf make. One that was told several times on /tf and
/// never changed by more than rounding is as fixed as one on /tf_static.
class FrameTree {
 public:
  /// A message that can not be read, and transforms that are not finite, are passed over.
  void add(const Topic& topic, std::string_view bytes);

  /// T_ancestor_frame, by fixed transforms; nothing where the frame does not hang on that ancestor by these.
  [[nodiscard]] std::optional<Eigen::Isometry3d> find(const std::string& ancestor,
                                                      const std::string& frame) const;

  /// The name in the tree of a frame that messages name without its prefix ("base_link" for
  /// "robot1/base_link"), or with one that the tree lacks. The frame itself where several would do.
  [[nodiscard]] std::string resolve(const std::string& frame) const;

  /// Does the robot, which is told in this frame, move in it?
  [[nodiscard]] bool moves_in(const std::string& robot, const std::string& frame) const;

  /// Frames that nothing else is fixed in.
  [[nodiscard]] std::vector<std::string> leaves() const;

 private:
  struct Joint {
    std::string parent;
    Eigen::Isometry3d T_parent_frame;
    bool is_static = false;  ///< told on /tf_static
    bool changes = false;
    int told = 0;

    [[nodiscard]] bool is_fixed() const { return is_static || (!changes && told > 1); }
  };
  void add(const std::string& frame, Joint joint);
  [[nodiscard]] bool has(const std::string& frame) const;

  std::map<std::string, Joint> joints_;  // by the frame that is told
};

}  // namespace waymark::bag
