#include "waymark/ekf/pixel_slam.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace waymark {
namespace {

struct PixelBlock {
  enum : std::size_t { kPredict, kProject, kJacobians, kEstimate, kWeights, kAdd };
};

bool is_usable(const Observation& observation) {
  const auto* z = std::get_if<Pixel>(&observation.value);
  return z != nullptr && std::isfinite(z->u_px) && std::isfinite(z->v_px) &&
         (!observation.covariance || observation.covariance->allFinite());
}

Eigen::Vector2d pixel_of(const Observation& observation) {
  const auto& pixel = std::get<Pixel>(observation.value);
  return {pixel.u_px, pixel.v_px};
}

}  // namespace

PixelSlam::PixelSlam(const PixelSlamOptions& options, const CameraOptions& camera, int threads)
    : prediction_(options, camera),
      map_(options, prediction_.camera(), threads),
      initialiser_(options, map_, prediction_),
      update_(options, map_, prediction_) {
  const auto features = static_cast<std::size_t>(options.capacity);
  const auto known = features + static_cast<std::size_t>(options.max_candidates);
  expectations_.reserve(known);
  innovations_.reserve(known);
  found_.reserve(features);
  found_in_.reserve(features);
  prediction_.noise().begin_image(map_.map().state());
}

void PixelSlam::predict(const Motion& motion) {
  BlockTimer timer(blocks_, PixelBlock::kPredict);
  in_image_ = false;
  if (!is_still(motion) && is_finite(motion)) map_.map().state().predict(motion);  // Vincke Algorithm 1
  timer.finish(PixelBlock::kPredict);
}

void PixelSlam::begin_image() {
  in_image_ = true;
  map_.begin_image();
  prediction_.noise().begin_image(map_.map().state());
  initialiser_.begin_image();
  map_.retire();
}

std::span<const Expectation> PixelSlam::expect() {
  BlockTimer timer(blocks_, PixelBlock::kProject);
  begin_image();
  expectations_.clear();
  const CameraPose here = prediction_.camera_pose(map());
  for (int i = 0; i < static_cast<int>(map().features().size()); ++i)
    if (const auto expected = prediction_.expect(map_.map(), i, here)) expectations_.push_back(*expected);
  std::ranges::copy(initialiser_.expect(), std::back_inserter(expectations_));
  timer.finish(PixelBlock::kProject);
  return expectations_;
}

/// What follows the search in algorithm 1 of Vincke et al. 2012: the estimation (equations 10 to 12), then
/// the initialisation, of candidates that were found before new ones.
const Correction& PixelSlam::correct(std::span<const Observation> observations,
                                     std::span<const LandmarkId> missed) {
  miss(missed);
  BlockTimer timer(blocks_, PixelBlock::kJacobians);
  if (!in_image_) begin_image();
  identify(observations);
  timer.finish(PixelBlock::kJacobians);
  update(observations);  // Vincke Algorithm 1
  convert_rays();
  timer.finish(PixelBlock::kEstimate);
  weigh_candidates(observations);  // Vincke Algorithm 1
  timer.finish(PixelBlock::kWeights);
  begin_candidates(observations);  // Vincke Algorithm 1
  timer.finish(PixelBlock::kAdd);
  correction_ = {innovations_, map_.removed()};
  return correction_;
}

void PixelSlam::miss(std::span<const LandmarkId> landmarks) {
  for (const LandmarkId id : landmarks) {
    if (const auto feature = map().find(id))
      map_.missed(*feature);
    else
      initialiser_.missed(id);
  }
}

/// Decides what each observation is of: a landmark or a candidate, kMatched so far, or something new, kAdded.
void PixelSlam::identify(std::span<const Observation> observations) {
  innovations_.assign(observations.size(), {});
  for (std::size_t i = 0; i < observations.size(); ++i) {
    innovations_[i].outcome = Outcome::kUnusable;
    if (!is_usable(observations[i])) continue;
    innovations_[i].outcome = Outcome::kUnidentified;
    if (!observations[i].id) continue;
    innovations_[i].landmark = *observations[i].id;
    innovations_[i].outcome = what_is(i);
  }
}

Outcome PixelSlam::what_is(std::size_t index) const {
  const LandmarkId id = innovations_[index].landmark;
  const auto earlier = std::span(innovations_).first(index);
  const bool again = std::ranges::any_of(earlier, [id](const Innovation& one) {
    return one.landmark == id && one.outcome != Outcome::kUnusable;
  });
  if (again) return Outcome::kDuplicate;
  return map().find(id) || initialiser_.knows(id) ? Outcome::kMatched : Outcome::kAdded;
}

/// With all landmarks that were found.
void PixelSlam::update(std::span<const Observation> observations) {
  found_.clear();
  found_in_.clear();
  for (std::size_t i = 0; i < observations.size(); ++i) {
    if (innovations_[i].outcome != Outcome::kMatched) continue;
    const auto feature = map().find(innovations_[i].landmark);
    if (!feature) continue;
    found_.push_back({*feature, pixel_of(observations[i]), prediction_.noise().of(observations[i])});
    found_in_.push_back(i);
  }
  const auto innovations = update_.update(found_);
  for (std::size_t k = 0; k < found_.size(); ++k) innovations_[found_in_[k]] = innovations[k];
}

/// Those that were just seen.
void PixelSlam::convert_rays() {
  const Eigen::Vector3d here = prediction_.camera_pose(map()).p_world_camera;
  for (const Innovation& innovation : innovations_) {
    if (innovation.outcome != Outcome::kMatched) continue;
    if (const auto feature = map().find(innovation.landmark)) map_.convert_ray(*feature, here);
  }
}

/// With all candidates that were found. Those that are ready become landmarks.
void PixelSlam::weigh_candidates(std::span<const Observation> observations) {
  for (std::size_t i = 0; i < observations.size(); ++i) {
    Innovation& innovation = innovations_[i];
    if (innovation.outcome != Outcome::kMatched || !initialiser_.knows(innovation.landmark)) continue;
    const Eigen::Vector2d z_px = pixel_of(observations[i]);
    const Eigen::Matrix2d R = prediction_.noise().of(observations[i]);
    if (!initialiser_.weigh(innovation.landmark, z_px, R))
      innovation.outcome = Outcome::kGated;
    else if (initialiser_.is_ready(innovation.landmark))
      accept(innovation, z_px, R);
  }
}

/// A candidate becomes a landmark; of a ray the state learns the depth from the pixel that was just weighed.
void PixelSlam::accept(Innovation& innovation, const Eigen::Vector2d& z_px, const Eigen::Matrix2d& R) {
  const auto feature = initialiser_.accept(innovation.landmark);
  if (!feature || map().feature(*feature).is_point()) return;
  if (const auto confirmed = update_.confirm({*feature, z_px, R})) innovation = *confirmed;
}

/// With all that is new.
void PixelSlam::begin_candidates(std::span<const Observation> observations) {
  for (std::size_t i = 0; i < observations.size(); ++i)
    if (innovations_[i].outcome == Outcome::kAdded)
      innovations_[i].outcome = initialiser_.begin(innovations_[i].landmark, pixel_of(observations[i]),
                                                   prediction_.noise().of(observations[i]));
}

Snapshot PixelSlam::snapshot() const {
  const MapState saved = save();
  Snapshot snapshot;
  snapshot.pose = pose();
  for (std::size_t k = 0; k < saved.ids.size(); ++k) {
    const auto at = static_cast<int>(3 * k);
    snapshot.landmarks.push_back({saved.ids[k],
                                  saved.landmarks.segment<3>(at),
                                  saved.covariance.block<3, 3>(3 + at, 3 + at),
                                  saved.observations[k],
                                  {}});
  }
  return snapshot;
}

}  // namespace waymark
