#include "workbench/bags/frame_tree.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "workbench/bags/message_decoder.hpp"

namespace waymark::bag {
namespace {

/// What rounding to single precision and back changes.
constexpr double kRounding = 1e-5;

bool is_same(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
  return (a.matrix() - b.matrix()).cwiseAbs().maxCoeff() < kRounding;
}

std::string_view last_name(std::string_view frame) { return frame.substr(frame.rfind('/') + 1); }

}  // namespace

std::string plain_frame(std::string_view frame) {
  if (frame.starts_with('/')) frame.remove_prefix(1);
  return std::string(frame);
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
    const bool is_finite = std::ranges::all_of(n, [](double value) { return std::isfinite(value); });
    if (!is_finite || q.norm() < 1e-3) continue;
    add(plain_frame(frames[i]),
        {plain_frame(parents[i]), Eigen::Translation3d(n[0], n[1], n[2]) * q.normalized(),
         topic.name.ends_with("tf_static"), false, 1});
  }
}

void FrameTree::add(const std::string& frame, Joint joint) {
  const auto [place, is_new] = joints_.emplace(frame, joint);
  if (is_new) return;
  Joint& known = place->second;
  if (known.is_static && !joint.is_static) return;
  joint.told = known.told + 1;
  joint.changes =
      known.changes || known.parent != joint.parent || !is_same(known.T_parent_frame, joint.T_parent_frame);
  known = joint;
}

std::optional<Eigen::Isometry3d> FrameTree::find(const std::string& ancestor,
                                                 const std::string& frame) const {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  std::string at = frame;
  for (std::size_t steps = 0; at != ancestor; ++steps) {
    const auto joint = joints_.find(at);
    if (joint == joints_.end() || !joint->second.is_fixed() || steps > joints_.size()) return std::nullopt;
    T = joint->second.T_parent_frame * T;
    at = joint->second.parent;
  }
  return T;
}

bool FrameTree::has(const std::string& frame) const {
  return joints_.contains(frame) ||
         std::ranges::any_of(joints_, [&](const auto& each) { return each.second.parent == frame; });
}

std::string FrameTree::resolve(const std::string& frame) const {
  if (frame.empty() || has(frame)) return frame;
  std::set<std::string> alike;
  for (const auto& [name, joint] : joints_)
    for (const std::string& each : {name, joint.parent})
      if (last_name(each) == last_name(frame)) alike.insert(each);
  return alike.size() == 1 ? *alike.begin() : frame;
}

bool FrameTree::moves_in(const std::string& robot, const std::string& frame) const {
  std::string at = robot;
  bool moves = false;
  for (std::size_t steps = 0; at != frame; ++steps) {
    const auto joint = joints_.find(at);
    if (joint == joints_.end() || steps > joints_.size()) return false;
    moves = moves || joint->second.changes;
    at = joint->second.parent;
  }
  return moves;
}

std::vector<std::string> FrameTree::leaves() const {
  std::vector<std::string> leaves;
  for (const auto& [name, joint] : joints_)
    if (joint.is_fixed() &&
        std::ranges::none_of(joints_, [&](const auto& each) { return each.second.parent == name; }))
      leaves.push_back(name);
  return leaves;
}

}  // namespace waymark::bag
