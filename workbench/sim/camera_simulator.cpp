#include "workbench/sim/camera_simulator.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Geometry>

namespace waymark::sim {
namespace {

// One stream of images for each of these, and one number per jump in brightness.
enum Draw : std::uint32_t { kPitch, kRoll, kHeight, kDrift, kJump, kDrop };

RandomStream stream(std::uint64_t seed, Draw what, std::uint64_t step = 0) {
  return {seed, StreamPurpose::kImages, step, what};
}

// Pixels that the image may move between two moments that are averaged.
constexpr double kStep_px = 0.5;
constexpr int kMomentsMax = 16;
// To things that are near but mostly not that near.
constexpr double kTypicalDepth_m = 2.0;

Duration exposure(const CameraSimulatorOptions& options) {
  return duration_from_seconds(options.exposure_ms * 1e-3);
}

kernels::ImageNoiseModel noise_model(const CameraSimulatorOptions& options, std::uint64_t seed) {
  kernels::ImageNoiseModel model{.noise_grey = static_cast<float>(options.noise_grey),
                                 .seed = seed,
                                 .purpose = static_cast<std::uint32_t>(StreamPurpose::kImages)};
  const double s = std::max(options.lens_blur_px, 1e-3);
  double sum = 0.0;
  const auto weight = [s](int k) { return std::exp(-0.5 * k * k / (s * s)); };
  for (int k = -kernels::kBlurRadiusMax; k <= kernels::kBlurRadiusMax; ++k) sum += weight(k);
  for (int k = 0; k <= kernels::kBlurRadiusMax; ++k) model.weights[k] = static_cast<float>(weight(k) / sum);
  return model;
}

}  // namespace

Vibration::Vibration(RandomStream random) {
  for (std::size_t i = 0; i < frequency_hz_.size(); ++i) {
    frequency_hz_[i] = random.uniform(4.0, 12.0);
    phase_rad_[i] = random.uniform(-kPi, kPi);
  }
}

double Vibration::at(double time_s) const {
  double sum = 0.0;
  for (std::size_t i = 0; i < frequency_hz_.size(); ++i)
    sum += std::sin(2.0 * kPi * frequency_hz_[i] * time_s + phase_rad_[i]);
  return sum * std::sqrt(2.0 / static_cast<double>(frequency_hz_.size()));
}

CameraSimulator::CameraSimulator(const CameraSimulatorOptions& options, Scene scene, Drive drive,
                                 std::uint64_t seed, int threads)
    : options_(options),
      scene_(std::move(scene)),
      drive_(std::move(drive)),
      seed_(seed),
      camera_(camera_of(options)),
      pool_(threads),
      renderer_(camera_, pool_),
      pitch_(stream(seed, kPitch)),
      roll_(stream(seed, kRoll)),
      height_(stream(seed, kHeight)),
      drift_phase_rad_(stream(seed, kDrift).uniform(-kPi, kPi)) {}

Stamp CameraSimulator::stamp(std::size_t image) const {
  return stamp_from_seconds(static_cast<double>(image) / options_.rate_hz);
}

std::size_t CameraSimulator::size() const {
  auto count = static_cast<std::size_t>(to_seconds(drive_.end()) * options_.rate_hz);
  while (stamp(count) <= drive_.end()) ++count;
  return count;
}

bool CameraSimulator::is_lost(std::size_t image) const {
  return stream(seed_, kDrop, image).uniform() < options_.drop_probability;
}

std::size_t CameraSimulator::number(Stamp stamp) const {
  return static_cast<std::size_t>(std::llround(to_seconds(stamp) * options_.rate_hz));
}

Viewpoint CameraSimulator::viewpoint(Stamp when) const {
  const CameraPose pose = camera_.pose(drive_.at(std::clamp(when, drive_.stamp(0), drive_.end())));
  const double time_s = to_seconds(when);
  const auto turn = [](double degrees, const Eigen::Vector3d& axis) {
    return Eigen::AngleAxisd(to_radians(degrees), axis);
  };
  const Eigen::Matrix3d shake =
      (turn(options_.vibration_pitch_deg * pitch_.at(time_s), Eigen::Vector3d::UnitY()) *
       turn(options_.vibration_roll_deg * roll_.at(time_s), Eigen::Vector3d::UnitX()))
          .toRotationMatrix();
  const Eigen::Matrix3d R_robot_camera = options_.mount.R_robot_camera();
  return {R_robot_camera.transpose() * shake.transpose() * R_robot_camera * pose.R_camera_world,
          pose.p_world_camera + options_.vibration_height_m * height_.at(time_s) * Eigen::Vector3d::UnitZ()};
}

double CameraSimulator::brightness(Stamp when) const {
  const double time_s = to_seconds(when);
  const double covered_s = time_s - options_.covered_from_s;
  if (covered_s >= 0.0 && covered_s < options_.covered_for_s) return 0.0;
  const double drift =
      options_.drift_ratio * std::sin(2.0 * kPi * time_s / options_.drift_period_s + drift_phase_rad_);
  const auto jumps = static_cast<std::uint64_t>(time_s / options_.jump_interval_s);
  const double jump = jumps == 0 ? 0.0 : options_.jump_ratio * stream(seed_, kJump, jumps).uniform(-1.0, 1.0);
  return options_.brightness * (1.0 + drift) * (1.0 + jump);
}

/// Into how many moments an exposure is cut: enough for no gaps in what moves.
int CameraSimulator::moments(Stamp when) const {
  const Viewpoint first = viewpoint(when - exposure(options_) / 2);
  const Viewpoint last = viewpoint(when + exposure(options_) / 2);
  const double turn_rad = Eigen::AngleAxisd(last.R_camera_world * first.R_camera_world.transpose()).angle();
  const double move_m = (last.p_world_camera - first.p_world_camera).norm();
  const double motion_px = camera_.options().fu_px * (turn_rad + move_m / kTypicalDepth_m);
  return std::clamp(static_cast<int>(std::ceil(motion_px / kStep_px)), 1, kMomentsMax);
}

GreyImage CameraSimulator::take(std::size_t image) {
  const Stamp middle = stamp(image);
  const std::vector<Rectangle> rectangles = scene_.at(middle);
  const int count = moments(middle);
  renderer_.clear();
  for (int i = 0; i < count; ++i) {
    const double part = (i + 0.5) / count - 0.5;
    const Stamp moment = middle + duration_from_seconds(part * to_seconds(exposure(options_)));
    renderer_.expose(scene_.textures, rectangles, viewpoint(moment), 1.0 / count);
  }
  kernels::ImageNoiseModel how = noise_model(options_, seed_);
  how.gain = static_cast<float>(brightness(middle));
  how.frame = static_cast<std::uint32_t>(image);
  return renderer_.apply_image_noise(how);
}

}  // namespace waymark::sim
