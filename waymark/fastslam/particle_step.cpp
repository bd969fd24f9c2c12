#include "waymark/fastslam/particle_step.hpp"

namespace waymark::fastslam {
namespace {

using kernels::ParticleRange;

constexpr float narrow(double value) { return static_cast<float>(value); }

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

void update_block(std::span<const AcceptedSighting> sightings, double* log_weight, BlockScratch& scratch,
                  ParticleRange range) {
  const kernels::PoseColumns sensors = scratch.sensors();
  for (const AcceptedSighting& each : sightings) {
    // Most sightings of a scan are made from one place.
    if (&each == sightings.data() || each.sighting.mount != (&each - 1)->sighting.mount)
      kernels::place_sensors(scratch.robots(), each.sighting.mount, sensors, range.count);
    kernels::update_landmark(each.sighting, sensors, each.evidence, each.shapes_motion ? nullptr : log_weight,
                             range);
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
  return {narrow(d.x_m), narrow(d.y_m), narrow(d.theta_rad), P(0, 0), P(0, 1), P(0, 2), P(1, 1),
          P(1, 2),       P(2, 2)};
}

void step(Particles& particles, const Motion& motion, const Eigen::Vector2d& origin_m,
          std::span<const AcceptedSighting> sightings, const StreamKey& key, ParticleBlocks& blocks) {
  const kernels::Increment increment = increment_of(motion);
  const bool moves = !is_still(motion);
  blocks.run([&](std::size_t begin, std::size_t end) {
    BlockScratch scratch;
    const ParticleRange range{begin, end - begin};
    double* const log_weight = particles.log_weights().data() + begin;
    kernels::load_poses(particles.world(begin), origin_m.x(), origin_m.y(), scratch.robots(), range.count);
    kernels::fill_increments(increment, scratch.increments(), range.count);
    for (const AcceptedSighting& each : sightings)
      if (each.shapes_motion)
        kernels::condition_increments(each.sighting, increment, scratch.robots(), each.evidence,
                                      scratch.increments(), log_weight, range);
    if (moves) draw_block(particles, increment, key, scratch, range);
    update_block(sightings, log_weight, scratch, range);
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
