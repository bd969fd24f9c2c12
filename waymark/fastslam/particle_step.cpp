#include "waymark/fastslam/particle_step.hpp"

#include <algorithm>
#include <array>

#include "waymark/fastslam/narrow.hpp"

namespace waymark::fastslam {
namespace {

using kernels::ParticleRange;

void draw_block(Particles& particles, const kernels::Increment& increment, const StreamKey& key,
                BlockScratch& scratch, ParticleRange range) {
  const kernels::DrawKey draw{key.seed, static_cast<std::uint32_t>(key.purpose), key.step,
                              static_cast<std::uint32_t>(range.begin)};
  float* const n0 = scratch.normals(0);
  float* const n1 = scratch.normals(1);
  float* const n2 = scratch.normals(2);
  kernels::draw_normals(draw, n0, n1, n2, range.count);
  kernels::draw_poses(scratch.increments(), increment, n0, n1, n2, scratch.robots(),
                      particles.moving(range.begin), range.count);
}

/// Columns as they were, to be put back where an observation is not for a particle.
class Backup {
 public:
  Backup(std::span<float* const> columns, double* log_weight, std::size_t count)
      : columns_(columns), log_weight_(log_weight), count_(count) {
    for (std::size_t c = 0; c < columns.size(); ++c) std::copy_n(columns[c], count, values_[c]);
    std::copy_n(log_weight, count, log_weights_);
  }
  void restore_others(const float* takers) const {
    for (std::size_t i = 0; i < count_; ++i) {
      if (takers[i] != 0.0F) continue;
      for (std::size_t c = 0; c < columns_.size(); ++c) columns_[c][i] = values_[c][i];
      log_weight_[i] = log_weights_[i];
    }
  }

 private:
  static constexpr std::size_t kMaxColumns = 9;
  std::span<float* const> columns_;
  double* log_weight_;
  std::size_t count_;
  float values_[kMaxColumns][ParticleBlocks::kBlockSize];
  double log_weights_[ParticleBlocks::kBlockSize];
};

/// Runs `job` for those that take the observation; others keep their entries of the columns.
template <class Job>
void run_for_takers(const AcceptedObservation& observation, std::span<float* const> columns,
                    double* log_weight, ParticleRange range, const Job& job) {
  if (observation.takers == nullptr) return job();
  const Backup backup(columns, log_weight, range.count);
  job();
  backup.restore_others(observation.takers + range.begin);
}

void condition_block(const AcceptedObservation& each, const kernels::Increment& increment, double* log_weight,
                     BlockScratch& scratch, ParticleRange range) {
  const kernels::IncrementColumns d = scratch.increments();
  const std::array columns{d.x, d.y, d.t, d.xx, d.xy, d.xt, d.yy, d.yt, d.tt};
  run_for_takers(each, columns, log_weight, range, [&] {
    kernels::condition_increments(each.observation, increment, scratch.robots(), each.exponent, d, log_weight,
                                  range);
  });
}

void update_block(std::span<const AcceptedObservation> observations, double* log_weight,
                  BlockScratch& scratch, ParticleRange range) {
  const kernels::PoseColumns sensors = scratch.sensors();
  for (const AcceptedObservation& each : observations) {
    // Most observations of a scan are made from one place.
    if (&each == observations.data() || each.observation.mount != (&each - 1)->observation.mount)
      kernels::place_sensors(scratch.robots(), each.observation.mount, sensors, range.count);
    const auto& [a, b, aa, ab, bb] = each.observation.landmark.modes->gaussian;
    const std::array columns{a + range.begin, b + range.begin, aa + range.begin, ab + range.begin,
                             bb + range.begin};
    run_for_takers(each, columns, log_weight, range, [&] {
      kernels::update_landmark(each.observation, sensors, each.exponent,
                               each.shapes_motion ? nullptr : log_weight, range);
    });
  }
}

}  // namespace

kernels::Increment increment_of(const Motion& motion) {
  const Pose2& d = motion.increment;
  // The motion's covariance is that of its end. A deviation (x, y, theta) there is one of s = deviation about
  // the start: a turn theta moves the end by theta (-d_y, d_x), which is no deviation of s in place.
  Eigen::Matrix3d A = Eigen::Matrix3d::Identity();
  A(0, 2) = d.y_m;
  A(1, 2) = -d.x_m;
  const Eigen::Matrix3f P = (A * motion.covariance * A.transpose()).cast<float>();
  // Francisco (1)
  return {narrow(d.x_m), narrow(d.y_m), narrow(d.theta_rad), P(0, 0), P(0, 1), P(0, 2), P(1, 1),
          P(1, 2),       P(2, 2)};
}

void step(Particles& particles, const Motion& motion, const Eigen::Vector2d& origin_m,
          std::span<const AcceptedObservation> observations, const StreamKey& key, ParticleBlocks& blocks) {
  const kernels::Increment increment = increment_of(motion);
  const bool moves = !is_still(motion);
  blocks.run([&](std::size_t begin, std::size_t end) {
    BlockScratch scratch;
    const ParticleRange range{begin, end - begin};
    double* const log_weight = particles.log_weights().data() + begin;
    kernels::load_poses(particles.world(begin), origin_m.x(), origin_m.y(), scratch.robots(), range.count);
    kernels::fill_increments(increment, scratch.increments(), range.count);
    for (const AcceptedObservation& each : observations)
      if (each.shapes_motion) condition_block(each, increment, log_weight, scratch, range);
    if (moves) draw_block(particles, increment, key, scratch, range);  // Francisco (3)
    update_block(observations, log_weight, scratch, range);            // Francisco (4)
  });
}

kernels::PoseColumns load_sensors(const Particles& particles, const kernels::SensorMount& mount,
                                  const Eigen::Vector2d& origin_m, kernels::ParticleRange range,
                                  BlockScratch& scratch) {
  kernels::load_poses(particles.world(range.begin), origin_m.x(), origin_m.y(), scratch.robots(),
                      range.count);
  kernels::place_sensors(scratch.robots(), mount, scratch.sensors(), range.count);
  return scratch.sensors();
}

}  // namespace waymark::fastslam
