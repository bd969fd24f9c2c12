#include "waymark/fastslam/gate_sample.hpp"

#include <algorithm>

namespace waymark::fastslam {
namespace {

using kernels::InnovationSums;
using kernels::ObservationKind;
using kernels::ParticleRange;

constexpr std::size_t kSample = 1024;
// Sums over floats stay exact enough in pieces of so many.
constexpr std::size_t kPiece = 256;

// What sums are taken about: the innovation of one particle, so that opposite angles do not cancel and no
// digits are lost.
kernels::About about_first(const kernels::LandmarkObservation& observation,
                           const kernels::Increment& increment, const kernels::PoseColumns& poses) {
  alignas(64) constexpr std::array<double, kernels::kParticleLanes> kOnlyTheFirst{1.0};
  const InnovationSums first =
      kernels::compare_observation(observation, increment, poses, {}, kOnlyTheFirst.data(), {0, 1});
  if (!(first.w > 0.0)) return {};
  return {static_cast<float>(first.nu[0] / first.w), static_cast<float>(first.nu[1] / first.w)};
}

Eigen::Matrix2d symmetric(const std::array<double, 3>& sums, double w) {
  return Eigen::Matrix2d{{sums[0], sums[1]}, {sums[1], sums[2]}} / w;
}

InnovationMoments moments_of(const InnovationSums& sums, const kernels::About& about, ObservationKind kind) {
  const Eigen::Vector2d shift(sums.nu[0] / sums.w, sums.nu[1] / sums.w);
  InnovationMoments moments{Eigen::Vector2d(about.range, about.bearing) + shift,
                            symmetric(sums.nu_nu, sums.w) - shift * shift.transpose(),
                            symmetric(sums.L, sums.w)};
  if (kind == ObservationKind::kBearing || kind == ObservationKind::kViewEdge) {
    moments.mean[0] = moments.mean[1];
    moments.spread(0, 0) = moments.spread(1, 1);
    moments.noise(0, 0) = moments.noise(1, 1);
  }
  return moments;
}

template <std::size_t N>
void add(std::array<double, N>& sum, const std::array<double, N>& terms) {
  for (std::size_t k = 0; k < N; ++k) sum[k] += terms[k];
}

}  // namespace

GateSample::GateSample(int capacity)
    : stride_(kernels::round_up_particles(std::min(kSample, static_cast<std::size_t>(capacity)))),
      values_(4 * stride_) {}

kernels::PoseColumns GateSample::columns(std::size_t begin) {
  float* const first = values_.data() + begin;
  return {first, first + stride_, first + 2 * stride_, first + 3 * stride_};
}

void GateSample::load(const Particles& particles, const Eigen::Vector2d& origin_m) {
  weights_ = particles.weights().first(std::min(stride_, particles.weights().size()));
  kernels::load_poses(particles.world(), origin_m.x(), origin_m.y(), columns(0), weights_.size());
}

InnovationMoments GateSample::compare(const kernels::LandmarkObservation& observation,
                                      const kernels::Increment& increment) {
  const kernels::About about = about_first(observation, increment, columns(0));
  InnovationSums sums{};
  for (std::size_t begin = 0; begin < weights_.size(); begin += kPiece) {
    const ParticleRange range{begin, std::min(kPiece, weights_.size() - begin)};
    const InnovationSums part = kernels::compare_observation(observation, increment, columns(begin), about,
                                                             weights_.data() + begin, range);
    sums.w += part.w;
    add(sums.nu, part.nu);
    add(sums.nu_nu, part.nu_nu);
    add(sums.L, part.L);
  }
  return moments_of(sums, about, observation.seen.kind);
}

}  // namespace waymark::fastslam
