#include "waymark/fastslam/belief.hpp"

namespace waymark::fastslam {
namespace {

/// The belief's spread as a motion from its mean.
Motion spread_of(const PoseEstimate& pose) {
  Motion spread;
  const Eigen::Matrix3d G = compose_jacobian_right(pose.T_world_robot);
  spread.covariance = G.transpose() * pose.covariance * G;
  return spread;
}

/// 0 unless the range is all that was measured.
double range_alone_m(const Observation& observation) {
  const auto* z = std::get_if<Range>(&observation.value);
  return z != nullptr ? z->range_m : 0.0;
}

}  // namespace

Belief::Belief(const FastSlamOptions& options, const LandmarkSensor& sensor, int threads)
    : blocks(options.particles, threads),
      particles(options.particles, options.initial.T_world_robot),
      calibration(sensor, options.seed, blocks),
      store(blocks),
      landmarks(options.capacity),
      sample(options.particles),
      estimate(options.initial),
      seed(options.seed) {
  if (!options.initial.covariance.isZero(0.0))
    fastslam::step(particles, spread_of(options.initial), origin_m(), {},
                   {seed, StreamPurpose::kInitialisation, 0}, blocks);
}

void Belief::predict(const Motion& motion) {
  pending = compose(pending, motion);
  landmarks.travel(travelled_m(motion));
  has_moved = true;
}

void Belief::step(std::span<const AcceptedObservation> accepted) {
  const Eigen::Vector2d before_m = origin_m();
  estimate = pose();
  fastslam::step(particles, pending, before_m, accepted, {seed, StreamPurpose::kMotion, steps++}, blocks);
  pending = {};
}

void Belief::update_estimate() { estimate = fastslam::estimate(particles, blocks); }

void Belief::resample(std::span<const std::int32_t> ancestors) {
  particles.replace_by_ancestors(ancestors, blocks);
  calibration.replace_by_ancestors(ancestors);
  store.resample(ancestors);
}

int Belief::add(const LandmarkRecord& record, kernels::LandmarkForm form, std::size_t modes,
                const Observation& first) {
  landmarks.append(record);
  records.push_back(
      {.existence_probability = record.existence.probability(), .range_alone_m = range_alone_m(first)});
  return store.add(form, origin_m(), modes, record.identity == Identity::kUnknown);
}

void Belief::remove(int landmark) {
  store.remove(landmark);
  landmarks.remove(landmark);
  records[as_index(landmark)] = records.back();
  records.pop_back();
}

void Belief::observe(int landmark, const Observation& observation) {
  landmarks.observe(landmark);
  records[as_index(landmark)].range_alone_m = range_alone_m(observation);
}

PoseEstimate Belief::pose() const { return is_still(pending) ? estimate : propagate(estimate, pending); }

}  // namespace waymark::fastslam
