#include "workbench/live/pose_publisher.hpp"

#include <sys/socket.h>

#include <fmt/format.h>

#include "workbench/logs/number_text.hpp"

namespace waymark::live {

std::string to_json_line(const StampedPose& pose) {
  const Pose2& T = pose.estimate.T_world_robot;
  const Eigen::Matrix3d& P = pose.estimate.covariance;
  std::string text = "{\"stamp_s\":";
  append_stamp(text, pose.stamp);
  const auto add = [&text](const char* before, double value) {
    text += before;
    append_shortest(text, value);
  };
  add(",\"x_m\":", T.x_m);
  add(",\"y_m\":", T.y_m);
  add(",\"theta_rad\":", T.theta_rad);
  add(",\"covariance\":[", P(0, 0));
  for (const auto& [row, column] : {std::pair(0, 1), {0, 2}, {1, 1}, {1, 2}, {2, 2}})
    add(",", P(row, column));
  return text + "]}";
}

Result<PosePublisher> PosePublisher::open(std::string_view address) {
  const auto parsed = parse_address(address, 115200);
  if (!parsed) return parsed.error();
  if (parsed->kind != Address::Kind::kUdp)
    return Error{fmt::format("{}: poses are sent to udp://HOST:PORT", address)};
  auto socket = open_udp_sender(parsed->host, parsed->port);
  if (!socket) return socket.error();
  return PosePublisher(*std::move(socket));
}

void PosePublisher::send(const StampedPose& pose) {
  const std::string line = to_json_line(pose) + "\n";
  if (::send(socket_.get(), line.data(), line.size(), MSG_DONTWAIT | MSG_NOSIGNAL) < 0) ++lost_;
}

}  // namespace waymark::live
