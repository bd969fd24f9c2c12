#pragma once

#include <array>
#include <compare>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <Eigen/Core>

#include "waymark/core/grey_image.hpp"
#include "waymark/core/observation.hpp"
#include "waymark/core/pose2.hpp"
#include "waymark/core/stamp.hpp"

namespace waymark {

/// Cumulative encoder angles; forward rolling counts up on both sides.
struct WheelAngles {
  double left_rad = 0.0;
  double right_rad = 0.0;
};

/// Forward and turning speed, held until the next one.
struct Velocity {
  double v_mps = 0.0;
  double w_radps = 0.0;
};

/// Forward speed and steering angle (left positive), held until the next one.
struct Steering {
  double v_mps = 0.0;
  double steer_rad = 0.0;
};

/// The robot's own dead reckoning, in a frame that starts anywhere.
struct OdometryPose {
  Pose2 T_odom_robot;
};

/// Yaw rate measured by a gyro, counter-clockwise seen from above.
struct YawRate {
  double w_radps = 0.0;
};

/// An image: named by its file, to be loaded by who needs the pixels; or with its pixels where a simulator
/// or a camera has them in memory; or with the bytes of its file (JPEG, PNG), as bags have them.
struct Image {
  std::string file;
  std::shared_ptr<const GreyImage> pixels = nullptr;
  std::shared_ptr<const std::string> encoded = nullptr;
};

/// A square marker that another program found in an image: its corners clockwise from the upper left of its
/// pattern, px; the centre of the first pixel is at (0, 0).
struct MarkerOutline {
  std::int32_t id = -1;
  std::array<Eigen::Vector2d, 4> corners_px;

  friend bool operator==(const MarkerOutline&, const MarkerOutline&) = default;
};

/// All of one image.
using MarkerOutlines = std::vector<MarkerOutline>;

/// True position of the truth sensor. The heading may be unknown.
struct Truth {
  double x_m = 0.0;
  double y_m = 0.0;
  std::optional<double> theta_rad;
};

using EventContent = std::variant<WheelAngles, Velocity, Steering, OdometryPose, YawRate, Image,
                                  MarkerOutlines, Observations, Truth>;

/// Source of an event: robot and device. Logs of one robot with one device of each kind leave both at 0;
/// sources with more number the devices of a robot over all kinds.
struct StreamId {
  std::uint16_t robot = 0;
  std::uint16_t device = 0;

  friend auto operator<=>(const StreamId&, const StreamId&) = default;
};

/// One entry of a log: a stamp, its source and its content.
struct Event {
  /// Of the only robot, by its only device of the kind.
  Event(Stamp when, EventContent what) : Event(when, StreamId{}, std::move(what)) {}
  Event(Stamp when, StreamId who, EventContent what) : stamp(when), stream(who), content(std::move(what)) {}

  Stamp stamp;
  StreamId stream;
  EventContent content;
};

}  // namespace waymark
