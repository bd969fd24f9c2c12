#include "workbench/bags/imu_messages.hpp"

namespace waymark::bag {

int imu_rank(const Topic& topic) {
  if (topic.type != kImu) return -1;
  const auto mentions = [&topic](std::string_view word) {
    return topic.name.find(word) != std::string::npos;
  };
  if (mentions("accel")) return 2;
  return mentions("camera") || mentions("realsense") || mentions("zed") ? 1 : 0;
}

Eigen::Vector3d vertical_by_gravity(const Topic& topic, std::string_view bytes) {
  auto message = MessageDecoder::make(
      topic, {{"linear_acceleration.x", "linear_acceleration.y", "linear_acceleration.z"}, {}});
  if (!message || !message->decode(bytes)) return Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d a(message->number(0), message->number(1), message->number(2));
  Eigen::Index axis = 2;
  // A robot that drives off or brakes, and one that stands on a slope: less than half of gravity.
  constexpr double kHalfGravity_mps2 = 4.9;
  const bool is_gravity = a.allFinite() && a.cwiseAbs().maxCoeff(&axis) > kHalfGravity_mps2;
  return is_gravity ? Eigen::Vector3d(std::copysign(1.0, a[axis]) * Eigen::Vector3d::Unit(axis))
                    : Eigen::Vector3d(Eigen::Vector3d::UnitZ());
}

Result<TopicReader> imu_reader(const Topic& topic, const Eigen::Vector3d& vertical) {
  auto decoder =
      MessageDecoder::make(topic, {after_stamp({"angular_velocity.x", "angular_velocity.y",
                                                "angular_velocity.z", "angular_velocity_covariance"}),
                                   {}});
  if (!decoder) return decoder.error();
  return TopicReader{*std::move(decoder), true,
                     [vertical](const MessageDecoder& message) -> Result<EventContent> {
                       if (message.number(5) == -1.0)
                         return Error{"its covariance says that it has no angular velocity"};
                       const Eigen::Vector3d w(message.number(2), message.number(3), message.number(4));
                       if (!w.allFinite()) return Error{"its angular velocity is not finite"};
                       return EventContent(YawRate{vertical.dot(w)});
                     }};
}

}  // namespace waymark::bag
