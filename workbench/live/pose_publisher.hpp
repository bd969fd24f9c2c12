#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "workbench/live/descriptor.hpp"
#include "workbench/live/pose_of_now.hpp"

namespace waymark::live {

/// One line of JSON per pose, without an end of line: stamp_s, x_m, y_m, theta_rad, and the upper triangle of
/// the covariance of these, row by row, in m and rad.
[[nodiscard]] std::string to_json_line(const StampedPose& pose);

/// Sends the pose of now as a datagram of one line of JSON. Never blocks: what the socket cannot take is
/// counted. Sent by one thread.
class PosePublisher {
 public:
  /// `address` is udp://HOST:PORT.
  [[nodiscard]] static Result<PosePublisher> open(std::string_view address);

  void send(const StampedPose& pose);
  [[nodiscard]] std::int64_t lost() const { return lost_; }

 private:
  explicit PosePublisher(Descriptor socket) : socket_(std::move(socket)) {}

  Descriptor socket_;
  std::int64_t lost_ = 0;
};

}  // namespace waymark::live
