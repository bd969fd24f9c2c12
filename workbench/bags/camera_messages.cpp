#include "workbench/bags/camera_messages.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "waymark/core/angle.hpp"

#include "workbench/bags/message_decoder.hpp"
#include "workbench/logs/text_lines.hpp"

namespace waymark::bag {
namespace {

/// "/base_link", as old ROS wrote it, is "base_link".
std::string plain_frame(std::string_view frame) {
  if (frame.starts_with('/')) frame.remove_prefix(1);
  return std::string(frame);
}

bool is_finite(std::span<const double> values) {
  return std::ranges::all_of(values, [](double value) { return std::isfinite(value); });
}

/// Of the eight coefficients that some drivers write the last three must do nothing.
Result<Distortion> read_distortion(std::string_view model, std::span<const double> D) {
  const bool is_plumb_bob = model == "plumb_bob" || model.empty();
  const bool does_nothing = std::ranges::all_of(D, [](double d) { return d == 0.0; });
  if (does_nothing) return Distortion{};
  if (!is_plumb_bob || D.size() < 4 || !is_finite(D))
    return Error{fmt::format(
        "its distortion_model {} with {} coefficients is not supported; only plumb_bob with 4 or 5 is",
        in_quotes(model), D.size())};
  return Distortion{.k1 = D[0], .k2 = D[1], .p1 = D[2], .p2 = D[3], .k3 = D.size() > 4 ? D[4] : 0.0};
}

}  // namespace

Result<CameraOptions> read_camera_info(const Topic& topic, std::string_view bytes, bool rectified) {
  auto message = MessageDecoder::make(topic, {{"width", "height", "K", "D", "P"}, {"distortion_model"}});
  if (!message) return message.error();
  if (auto done = message->decode(bytes); !done) return done.error();
  const auto K = message->numbers(2), P = message->numbers(4);
  if (K.size() != 9 || P.size() != 12 || !is_finite(K) || !is_finite(P))
    return Error{"its matrices are not those of a camera"};
  CameraOptions camera{.width_px = static_cast<int>(std::min<std::uint32_t>(message->size(0), 1u << 20)),
                       .height_px = static_cast<int>(std::min<std::uint32_t>(message->size(1), 1u << 20)),
                       .fu_px = rectified ? P[0] : K[0],
                       .fv_px = rectified ? P[5] : K[4],
                       .cu_px = rectified ? P[2] : K[2],
                       .cv_px = rectified ? P[6] : K[5]};
  if (camera.fu_px <= 0.0 || camera.fv_px <= 0.0)
    return Error{"the camera was never calibrated: its matrix is zero"};
  if (rectified) return camera;
  auto distortion = read_distortion(message->text(0), message->numbers(3));
  if (!distortion) return distortion.error();
  camera.distortion = *distortion;
  return camera;
}

std::string read_frame(const Topic& topic, std::string_view bytes, const std::string& field) {
  auto message = MessageDecoder::make(topic, {{}, {field}});
  return message && message->decode(bytes) ? plain_frame(message->text(0)) : "";
}

void FrameTree::add(const Topic& topic, std::string_view bytes) {
  WantedFields wanted{{}, {"transforms.header.frame_id", "transforms.child_frame_id"}};
  for (const char* part : {"translation.x", "translation.y", "translation.z", "rotation.w", "rotation.x",
                           "rotation.y", "rotation.z"})
    wanted.numbers.push_back(std::string("transforms.transform.") + part);
  auto message = MessageDecoder::make(topic, wanted);
  if (!message || !message->decode(bytes)) return;
  const auto parents = message->texts(0), frames = message->texts(1);
  std::array<double, 7> n{};
  for (std::size_t i = 0; i < std::min(frames.size(), parents.size()); ++i) {
    for (std::size_t k = 0; k < n.size(); ++k)
      n[k] = i < message->numbers(k).size() ? message->numbers(k)[i] : NAN;
    const Eigen::Quaterniond q(n[3], n[4], n[5], n[6]);
    if (!is_finite(n) || q.norm() < 1e-3) continue;
    joints_[plain_frame(frames[i])] = {plain_frame(parents[i]),
                                       Eigen::Translation3d(n[0], n[1], n[2]) * q.normalized()};
  }
}

std::optional<Eigen::Isometry3d> FrameTree::find(const std::string& ancestor,
                                                 const std::string& frame) const {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  std::string at = frame;
  for (std::size_t steps = 0; at != ancestor; ++steps) {
    const auto joint = joints_.find(at);
    if (joint == joints_.end() || steps > joints_.size()) return std::nullopt;
    T = joint->second.T_parent_frame * T;
    at = joint->second.parent;
  }
  return T;
}

CameraMount to_mount(const Eigen::Isometry3d& T_robot_camera) {
  const Eigen::Matrix3d R = T_robot_camera.linear() * CameraMount{}.R_robot_camera().transpose();
  const Eigen::Vector3d p = T_robot_camera.translation();
  return {.x_m = p.x(),
          .y_m = p.y(),
          .z_m = p.z(),
          .roll_deg = to_degrees(std::atan2(R(2, 1), R(2, 2))),
          .pitch_deg = to_degrees(std::asin(std::clamp(-R(2, 0), -1.0, 1.0))),
          .yaw_deg = to_degrees(std::atan2(R(1, 0), R(0, 0)))};
}

}  // namespace waymark::bag
