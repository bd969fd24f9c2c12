#include "waymark/ekf/depth_initialiser.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include "waymark/core/chi2.hpp"
#include "waymark/core/gaussian.hpp"

namespace waymark::ekf {
namespace {

/// What particles claim of a depth is made so many times less sure where the state learns it anew: wide
/// enough that the two pixels it learns from decide, not the particles, which weigh with 1/25 then.
constexpr double kDepthInflation = 5.0;
/// Standard deviation of the depth over the depth from which on it is known.
constexpr double kDepthRatio = 0.3;

/// Of the inverse depth of something that was seen once: two standard deviations span all that it may be.
double unknown_rho_sigma(const DepthPrior& prior) {
  return 0.25 * (1.0 / prior.nearest_m - 1.0 / prior.farthest_m);
}

}  // namespace

DepthInitialiser::DepthInitialiser(const PixelSlamOptions& options, BoundedMap& map,
                                   const PixelPrediction& prediction)
    : options_(options),
      map_(map),
      prediction_(prediction),
      gate_(chi2_quantile(kPixelGateProbability, 2)),
      candidates_(static_cast<std::size_t>(options.max_candidates),
                  Candidate{.depths = DepthParticles(options.depth)}) {
  expectations_.reserve(candidates_.size());
}

void DepthInitialiser::begin_image() {
  if (anchor_) map_.map().release(*anchor_);
  anchor_.reset();
  for (Candidate& candidate : candidates_) {
    if (candidate.is_free()) continue;
    const bool fails = candidate.looks >= 10 && 2 * candidate.matches < candidate.looks;
    if (++candidate.images > 2 * kMaxImages || fails) give_up(candidate);
  }
}

std::span<const Expectation> DepthInitialiser::expect() {
  expectations_.clear();
  for (const Candidate& candidate : candidates_) {
    if (candidate.is_free()) continue;
    if (const auto expected = CandidatePrediction(candidate, map_.map(), prediction_).expect())
      expectations_.push_back(*expected);
  }
  return expectations_;
}

int DepthInitialiser::size() const {
  return static_cast<int>(
      std::ranges::count_if(candidates_, [](const Candidate& c) { return !c.is_free(); }));
}

/// Where a candidate is; the number of all slots where it is in none.
std::size_t DepthInitialiser::find(LandmarkId id) const {
  const auto found =
      std::ranges::find_if(candidates_, [id](const Candidate& c) { return !c.is_free() && c.id == id; });
  return static_cast<std::size_t>(found - candidates_.begin());
}

void DepthInitialiser::missed(LandmarkId id) {
  if (knows(id)) ++candidates_[find(id)].looks;
}

bool DepthInitialiser::weigh(LandmarkId id, const Eigen::Vector2d& z_px, const Eigen::Matrix2d& R) {
  Candidate& candidate = candidates_[find(id)];
  const CandidatePrediction predicted(candidate, map_.map(), prediction_);
  double min_nis = HUGE_VAL;
  ++candidate.looks;
  // w <- w N(z; h(rho), S(rho)) for each depth
  candidate.depths.score([&](double rho_per_m) {
    const auto at = predicted.at(rho_per_m);
    if (!at) return -HUGE_VAL;
    const Eigen::Matrix2d S = at->S + R;
    const auto nis = mahalanobis_squared<2>(z_px - at->pixel, S);
    if (!nis) return -HUGE_VAL;
    min_nis = std::min(min_nis, *nis);
    return -0.5 * (*nis + std::log(S.determinant()));
  });
  if (!(min_nis <= gate_)) return false;
  candidate.depths.take();  // Vincke Algorithm 1
  ++candidate.matches;
  return true;
}

bool DepthInitialiser::is_ready(LandmarkId id) const {
  const Candidate& candidate = candidates_[find(id)];
  const auto [mean, sigma] = candidate.depths.depth();
  const bool patient = options_.init == Initialization::kArticle;
  const bool known = sigma < kDepthRatio * mean;
  return candidate.matches >= (known ? kMinImages : kMaxImages) && (known || !patient);
}

std::optional<int> DepthInitialiser::accept(LandmarkId id) {
  Candidate& candidate = candidates_[find(id)];
  if (!map_.make_room()) {
    give_up(candidate);
    return std::nullopt;
  }
  PixelMap& map = map_.map();
  const auto [rho, sigma] = candidate.depths.inverse_depth();
  const bool as_point = options_.init == Initialization::kArticle;
  const double unsure =
      as_point ? sigma : std::min(kDepthInflation * sigma, unknown_rho_sigma(options_.depth));
  const int anchor = std::exchange(candidate.anchor, -1);
  const int feature =  // Vincke Algorithm 1
      map_.add_ray(candidate.id, anchor, candidate.ray(rho), ray_covariance(candidate.xy_covariance, unsure),
                   candidate.matches + 1);
  prediction_.add_process_noise(map, feature, prediction_.place(map, feature), prediction_.camera_pose(map));
  if (as_point) map.make_point(feature, prediction_.camera());
  map.release(anchor);
  return feature;
}

Outcome DepthInitialiser::begin(LandmarkId id, const Eigen::Vector2d& z_px, const Eigen::Matrix2d& R) {
  const auto ray = prediction_.camera().ray(z_px);
  const auto slot = std::ranges::find_if(candidates_, &Candidate::is_free);
  if (!ray || slot == candidates_.end()) return Outcome::kMapFull;
  if (!anchor_ && !map_.free_an_anchor()) return Outcome::kMapFull;
  if (!anchor_) anchor_ = map_.map().add_anchor();
  const Eigen::Matrix2d xy_covariance = ray->dxy_dpixel * R * ray->dxy_dpixel.transpose();
  const Eigen::Matrix2d J = jitter_of(*ray);
  map_.map().hold(*anchor_);
  slot->start(id, *anchor_, ray->xy, xy_covariance + J * J.transpose());
  return Outcome::kAdded;
}

/// What an attitude jitter of the camera does to the (x, y) of the ray that is seen at a pixel.
Eigen::Matrix2d DepthInitialiser::jitter_of(const PixelRay& ray) const {
  const Eigen::Vector3d direction = ray.xy.homogeneous();
  const auto image = prediction_.camera().project(direction);
  if (!image) return Eigen::Matrix2d::Zero();
  const BiasTerms jittered = prediction_.noise().attitude_jitter(direction, image->dpixel_dpoint);
  return -ray.dxy_dpixel * jittered[0].J.topRows<2>();
}

void DepthInitialiser::give_up(Candidate& candidate) {
  map_.give_up(candidate.id, std::exchange(candidate.anchor, -1));
}

}  // namespace waymark::ekf
