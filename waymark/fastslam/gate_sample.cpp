#include "waymark/fastslam/gate_sample.hpp"

#include <algorithm>
#include <utility>

namespace waymark::fastslam {
namespace {

using kernels::InnovationSums;
using kernels::ParticleRange;
using kernels::SightingKind;

constexpr std::size_t kSample = 1024;
// Sums over floats stay exact enough in pieces of so many.
constexpr std::size_t kPiece = 256;

// What sums are taken about: the innovation of one particle, so that opposite angles do not cancel and no
// digits are lost.
kernels::About about_first(const kernels::Sighting& sighting, const kernels::Increment& increment,
                           const kernels::PoseColumns& poses) {
  alignas(64) constexpr std::array<double, kernels::kParticleLanes> kOnlyTheFirst{1.0};
  const InnovationSums first =
      kernels::compare_sighting(sighting, increment, poses, {}, kOnlyTheFirst.data(), {0, 1});
  if (!(first[0] > 0.0)) return {};
  return {static_cast<float>(first[1] / first[0]), static_cast<float>(first[2] / first[0])};
}

InnovationMoments moments_of(const InnovationSums& sums, const kernels::About& about, SightingKind kind) {
  const double w = sums[0];
  const Eigen::Vector2d shift(sums[1] / w, sums[2] / w);
  const Eigen::Matrix2d second{{sums[3] / w, sums[4] / w}, {sums[4] / w, sums[5] / w}};
  InnovationMoments moments{Eigen::Vector2d(about.range, about.bearing) + shift,
                            second - shift * shift.transpose()};
  if (kind == SightingKind::kBearing) {
    std::swap(moments.mean[0], moments.mean[1]);
    std::swap(moments.covariance(0, 0), moments.covariance(1, 1));
  }
  return moments;
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

InnovationMoments GateSample::compare(const kernels::Sighting& sighting,
                                      const kernels::Increment& increment) {
  const kernels::About about = about_first(sighting, increment, columns(0));
  InnovationSums sums{};
  for (std::size_t begin = 0; begin < weights_.size(); begin += kPiece) {
    const ParticleRange range{begin, std::min(kPiece, weights_.size() - begin)};
    const InnovationSums part =
        kernels::compare_sighting(sighting, increment, columns(begin), about, weights_.data() + begin, range);
    for (std::size_t k = 0; k < sums.size(); ++k) sums[k] += part[k];
  }
  return moments_of(sums, about, sighting.seen.kind);
}

}  // namespace waymark::fastslam
