#include "waymark/ekf/pixel_slam.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include "waymark/core/angle.hpp"
#include "waymark/core/chi2.hpp"
#include "waymark/core/gaussian.hpp"
#include "waymark/ekf/negligible_change.hpp"

namespace waymark {
namespace {

struct PixelBlock {
  enum : std::size_t { kPredict, kProject, kJacobians, kEstimate, kWeights, kAdd };
};

// Anchors at most, so pictures whose rays may be under way at once.
constexpr int kMostAnchors = 40;
constexpr double kBorder_px = 8.0;
/// Variance of a place that is known to the whole pixel, px^2.
constexpr double kRounding = 1.0 / 12.0;
/// A point may be kept as (x, y, z) (Civera, Davison, Montiel 2008).
constexpr double kLinear = 0.1;
/// Part of the true sightings that agree with each other.
constexpr double kAgreement = 0.99;
/// A ray that has to be settled before that may be kept as a point if sigma of its depth over the depth is
/// less.
constexpr double kFairlySure = 0.1;
/// Standard deviation of an innovation from which on one sighting alone convinces nobody, px.
constexpr double kWide_px = 15.0;
/// From where on a landmark comes back that leads the state far, px, and how many must.
constexpr double kFar_px = 6.0;
constexpr std::size_t kWitnesses = 3;
/// Of the wrong agreements of landmarks that come back, in one picture.
constexpr double kFalseAlarms = 1e-3;
// A patch is recognised under this turn of the view and between these ratios of distances.
const double kLeastCosine = std::cos(to_radians(45.0));
constexpr double kNearest = 0.4, kFarthest = 2.5;
constexpr int kMostIterations = 5;
/// What particles claim of a depth is made so many times less sure where the state learns it anew.
constexpr double kWidening = 5.0;

bool is_usable(const Observation& observation) {
  const auto* z = std::get_if<Pixel>(&observation.value);
  return z != nullptr && std::isfinite(z->u_px) && std::isfinite(z->v_px) &&
         (!observation.covariance || observation.covariance->allFinite());
}

Eigen::Vector2d pixel_of(const Observation& observation) {
  const auto& pixel = std::get<Pixel>(observation.value);
  return {pixel.u_px, pixel.v_px};
}

/// Of a ray's (x, y, rho), where nothing else is known that they have in common.
Eigen::Matrix3d ray_covariance(const Eigen::Matrix2d& xy_covariance, double rho_sigma) {
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  covariance.topLeftCorner<2, 2>() = xy_covariance;
  covariance(2, 2) = rho_sigma * rho_sigma;
  return covariance;
}

/// Trace of the innovation covariance of the k-th sighting.
double width_px2(const ekf::State::JointCovariance& S, std::size_t k) {
  const auto row = static_cast<Eigen::Index>(2 * k);
  return S(row, row) + S(row + 1, row + 1);
}

/// Of those that agree, the one whose place was known best.
std::size_t narrowest(const ekf::State::JointCovariance& S, std::span<const char> agrees) {
  std::size_t best = 0;
  for (std::size_t k = 0; k < agrees.size(); ++k)
    if (agrees[k] != 0 && (agrees[best] == 0 || width_px2(S, k) < width_px2(S, best))) best = k;
  return best;
}

}  // namespace

PixelSlam::PixelSlam(const PixelSlamOptions& options, const CameraOptions& camera, int threads)
    : options_(options),
      camera_(camera),
      map_(options.capacity, kMostAnchors, options.consistency, threads, options.vibration_deg > 0.0 ? 1 : 0),
      management_(options.evict, options.capacity),
      agreement_(ekf::State::kMaxSightings),
      return_(ekf::State::kMaxSightings),
      gate_(chi2_quantile(options.gate_probability, 2)),
      agreement_gate_(chi2_quantile(kAgreement, 2)),
      candidates_(static_cast<std::size_t>(options.most_candidates),
                  Candidate{.depths = ekf::DepthParticles(options.depth)}) {
  const auto features = static_cast<std::size_t>(options.capacity);
  expectations_.reserve(features + candidates_.size());
  innovations_.reserve(features + candidates_.size());
  removed_.reserve(features + candidates_.size());
  sightings_.reserve(ekf::State::kMaxSightings);
  nus_.reserve(ekf::State::kMaxSightings);
  seen_.reserve(ekf::State::kMaxSightings);
  returning_.reserve(ekf::State::kMaxSightings);
  used_.reserve(ekf::State::kMaxSightings);
  told_.reserve(ekf::State::kMaxSightings);
  refined_.reserve(ekf::State::kMaxSightings);
  if (options.vibration_deg > 0.0) map_.state().relax_errors(0, 0.0);
  if (options.update == UpdateMethod::kTextbook) map_.state().use_textbook_update();
}

void PixelSlam::predict(const Motion& motion) {
  BlockTimer timer(blocks_, PixelBlock::kPredict);
  in_picture_ = false;
  if (!is_still(motion) && is_finite(motion)) map_.state().predict(motion);  // Vincke Algorithm 1
  timer.finish(PixelBlock::kPredict);
}

void PixelSlam::begin_picture() {
  in_picture_ = true;
  removed_.clear();
  management_.begin_scan();
  if (options_.vibration_deg > 0.0) map_.state().relax_errors(0, 0.0);
  if (anchor_) map_.release(*anchor_);
  anchor_.reset();
  for (Candidate& candidate : candidates_) {
    if (candidate.anchor < 0) continue;
    const bool fails = candidate.looks >= 10 && 2 * candidate.matches < candidate.looks;
    if (++candidate.pictures > 2 * options_.most_pictures || fails) drop(candidate);
  }
  retire();
}

/// What a vibration of the camera about its x and its z axis does to the pixel of a point, whose Jacobian to
/// the point is J.
ekf::ErrorTerms PixelSlam::vibration(const Eigen::Vector3d& p_camera, const PixelJacobian& J) const {
  ekf::ErrorTerms terms;
  if (options_.vibration_deg <= 0.0) return terms;
  terms[0].pair = 0;
  const double sigma_rad = to_radians(options_.vibration_deg);
  terms[0].J.topRows<2>() << sigma_rad * J * Eigen::Vector3d::UnitX().cross(p_camera),
      sigma_rad * J * Eigen::Vector3d::UnitZ().cross(p_camera);
  return terms;
}

Eigen::Matrix2d PixelSlam::model_noise() const {
  return options_.model_sigma_px * options_.model_sigma_px * Eigen::Matrix2d::Identity();
}

Eigen::Matrix2d PixelSlam::noise(const Observation& observation) const {
  const double own = options_.sigma_px * options_.sigma_px;
  return model_noise() + observation.covariance.value_or(own * Eigen::Matrix2d::Identity());
}

/// A feature as it should look from a pose, with `values` of what stands in the state; nothing where it
/// cannot be seen. The innovation is left to the caller.
template <class Values>
std::optional<PixelSlam::Sight> PixelSlam::look(const ekf::PixelMap::Feature& feature, const CameraPose& here,
                                                const Values& values) const {
  Sight seen;
  seen.sighting.landmark = feature.element;
  if (feature.is_point()) {
    const auto h = observe_point(camera_, here, values(feature.element));
    if (!h) return std::nullopt;
    seen.sighting.H_pose = h->H_pose;
    seen.sighting.H_landmark = h->H_landmark;
    seen.sighting.errors = vibration(h->p_camera, h->dpixel_dpoint);
    seen.predicted = h->predicted;
  } else {
    seen.sighting.anchor = map_.anchor_element(feature.anchor);
    const Eigen::Vector3d anchor = values(seen.sighting.anchor);
    const auto h =
        observe_ray(camera_, here, camera_.pose({anchor[0], anchor[1], anchor[2]}), values(feature.element));
    if (!h) return std::nullopt;
    seen.sighting.H_pose = h->H_pose;
    seen.sighting.H_landmark = h->H_ray;
    seen.sighting.H_anchor = h->H_anchor;
    seen.sighting.errors = vibration(h->p_camera, h->dpixel_dpoint);
    seen.predicted = h->predicted;
  }
  return seen;
}

/// As it should look at the present estimate, Jacobians where the consistency mode wants them.
std::optional<PixelSlam::Sight> PixelSlam::sight(int index, const CameraPose& here) const {
  const ekf::State& state = map_.state();
  const ekf::PixelMap::Feature& feature = map_.feature(index);
  auto seen = look(feature, here, [&](int element) { return state.landmark(element); });
  if (!seen || state.consistency() != ekf::Consistency::kFej) return seen;
  auto first = look(feature, camera_.pose(state.linearization_pose()),
                    [&](int element) { return state.linearization_landmark(element); });
  if (first) first->predicted = seen->predicted;
  return first;
}

/// Points are known by how they looked, which holds from about where they were first seen.
bool PixelSlam::is_in_view(const ekf::PixelMap::Feature& feature, const CameraPose& here,
                           const Eigen::Vector2d& pixel) const {
  if (!camera_.sees(pixel, kBorder_px)) return false;
  if (!feature.is_point()) return true;
  const Eigen::Vector3d view = here.p_world_camera - map_.state().landmark(feature.element);
  const double ratio = view.norm() / feature.first_view_m.norm();
  return ratio > kNearest && ratio < kFarthest &&
         view.normalized().dot(feature.first_view_m.normalized()) > kLeastCosine;
}

std::span<const Expectation> PixelSlam::expect() {
  BlockTimer timer(blocks_, PixelBlock::kProject);
  begin_picture();
  expectations_.clear();
  const CameraPose here = camera_pose();
  for (int i = 0; i < static_cast<int>(map_.features().size()); ++i) expect_feature(i, here);
  for (const Candidate& candidate : candidates_)
    if (candidate.anchor >= 0) expect_candidate(candidate);
  timer.finish(PixelBlock::kProject);
  return expectations_;
}

/// Where a feature is; a ray that leads behind infinity as far away as points may be.
Eigen::Vector3d PixelSlam::place(const ekf::PixelMap::Feature& feature) const {
  if (feature.is_point()) return map_.state().landmark(feature.element);
  const Eigen::Vector3d values = map_.state().landmark(feature.element);
  const double least_rho = 1.0 / options_.depth.farthest_m;
  return point_of_ray(camera_.pose(map_.anchor_pose(feature.anchor)),
                      {values[0], values[1], std::max(values[2], least_rho)})
      .p_world;
}

double PixelSlam::wandered_px2(const Eigen::Vector3d& p_world, const Eigen::Vector3d& from,
                               const Eigen::Vector3d& to) const {
  const Eigen::Vector3d before = from - p_world, now = to - p_world;
  const double angle_rad = std::atan2(before.cross(now).norm(), before.dot(now));
  return options_.wander_px * options_.wander_px * to_degrees(angle_rad);
}

/// A patch is no point. Warped as a plane that faces the camera it fits best a little beside where it was
/// cut, and the more so the more the view has turned. Pictures from nearly the same place are off by the
/// same: an error of the landmark, not of the pixel.
void PixelSlam::let_wander(int index, const Eigen::Vector3d& p_world, const CameraPose& here) {
  ekf::PixelMap::Feature& feature = map_.feature(index);
  const Eigen::Vector3d view = p_world - here.p_world_camera;
  const double metres_per_px = view.norm() / camera_.options().fu_px;
  const double variance_m2 =
      wandered_px2(p_world, feature.seen_from_m, here.p_world_camera) * metres_per_px * metres_per_px;
  feature.seen_from_m = here.p_world_camera;
  const double rho = map_.state().landmark(feature.element)[2];
  const Eigen::Vector3d along = view.normalized();
  map_.state().loosen(feature.element,
                      feature.is_point()
                          ? (variance_m2 * (Eigen::Matrix3d::Identity() - along * along.transpose())).eval()
                          : ray_covariance(variance_m2 * rho * rho * Eigen::Matrix2d::Identity(), 0.0));
}

/// Adds it to the expectations if it should be in the picture.
void PixelSlam::expect_feature(int index, const CameraPose& here) {
  auto seen = sight(index, here);
  const ekf::PixelMap::Feature& feature = map_.feature(index);
  if (!seen || !is_in_view(feature, here, seen->predicted)) return;
  const Eigen::Vector3d p_world = place(feature);
  let_wander(index, p_world, here);
  seen->sighting.R = model_noise() + kRounding * Eigen::Matrix2d::Identity();
  Expectation expected;
  expected.id = feature.id;
  expected.predicted_px = seen->predicted;
  expected.S = map_.state().innovation_covariance(seen->sighting);
  if (!(expected.S.determinant() > 0.0)) return;
  expected.p_world_m = p_world;
  expected.information_nats = 0.5 * std::log(expected.S.determinant() / seen->sighting.R.determinant());
  expectations_.push_back(expected);
}

PixelSlam::Baseline PixelSlam::baseline(const Candidate& candidate) const {
  const ekf::State& state = map_.state();
  const std::size_t anchor = state.offset(map_.anchor_element(candidate.anchor));
  const std::array<std::size_t, 6> rows{0, 1, 2, anchor, anchor + 1, anchor + 2};
  Baseline line{camera_pose(), camera_.pose(map_.anchor_pose(candidate.anchor)), {}};
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j)
      line.P(i, j) = state.covariance(rows[static_cast<std::size_t>(i)], rows[static_cast<std::size_t>(j)]);
  return line;
}

/// Where a candidate of inverse depth rho should appear, and how sure that is: without the noise of the
/// pixel.
std::optional<PixelSlam::PredictedPixel> PixelSlam::predict_pixel(const Candidate& candidate,
                                                                  const Baseline& baseline,
                                                                  double rho) const {
  const auto h =
      observe_ray(camera_, baseline.here, baseline.anchor, {candidate.xy.x(), candidate.xy.y(), rho});
  if (!h) return std::nullopt;
  Eigen::Matrix<double, 2, 6> H;
  H << h->H_pose, h->H_anchor;
  const Eigen::Matrix2d H_xy = h->H_ray.leftCols<2>();
  const ekf::ErrorTerms shaken = vibration(h->p_camera, h->dpixel_dpoint);
  const Eigen::Matrix2d J = shaken[0].J.topRows<2>();
  const double wandered =
      rho > 0.0
          ? wandered_px2(point_of_ray(baseline.anchor, {candidate.xy.x(), candidate.xy.y(), rho}).p_world,
                         baseline.anchor.p_world_camera, baseline.here.p_world_camera)
          : 0.0;
  return PredictedPixel{h->predicted, H * baseline.P * H.transpose() +
                                          H_xy * candidate.xy_covariance * H_xy.transpose() +
                                          J * J.transpose() + wandered * Eigen::Matrix2d::Identity()};
}

/// The moments of the pixels that its depths predict, by three of them (Gauss and Hermite).
void PixelSlam::expect_candidate(const Candidate& candidate) {
  const Baseline line = baseline(candidate);
  const auto [mean, sigma] = candidate.depths.inverse_depth();
  const double step = std::sqrt(3.0) * sigma;
  const auto middle = predict_pixel(candidate, line, mean);
  const auto near = predict_pixel(candidate, line, mean + step);
  const auto far = predict_pixel(candidate, line, std::max(0.0, mean - step));
  if (!middle || !near || !far) return;
  Expectation expected;
  expected.id = candidate.id;
  expected.candidate = true;
  expected.predicted_px = (4.0 * middle->pixel + near->pixel + far->pixel) / 6.0;
  expected.S = model_noise() + kRounding * Eigen::Matrix2d::Identity();
  for (const auto& [weight, at] : {std::pair(4.0 / 6.0, *middle), {1.0 / 6.0, *near}, {1.0 / 6.0, *far}}) {
    const Eigen::Vector2d d = at.pixel - expected.predicted_px;
    expected.S += weight * (at.S + d * d.transpose());
  }
  if (!camera_.sees(expected.predicted_px, kBorder_px) || !expected.S.allFinite()) return;
  expected.p_world_m = point_of_ray(line.anchor, {candidate.xy.x(), candidate.xy.y(), mean}).p_world;
  expectations_.push_back(expected);
}

void PixelSlam::miss(std::span<const LandmarkId> landmarks) {
  for (const LandmarkId id : landmarks) {
    if (const auto feature = map_.find(id))
      management_.missed(*feature);
    else if (Candidate* candidate = find_candidate(id))
      ++candidate->looks;
  }
}

const Correction& PixelSlam::correct(std::span<const Observation> observations,
                                     std::span<const LandmarkId> missed) {
  miss(missed);
  BlockTimer timer(blocks_, PixelBlock::kJacobians);
  if (!in_picture_) begin_picture();
  innovations_.assign(observations.size(), {});
  for (std::size_t i = 0; i < observations.size(); ++i) sort_out(i, observations[i]);
  timer.finish(PixelBlock::kJacobians);
  update(observations);  // Vincke Algorithm 1
  settle_rays();
  timer.finish(PixelBlock::kEstimate);
  for (std::size_t i = 0; i < observations.size(); ++i)
    if (innovations_[i].outcome == Outcome::kMatched && find_candidate(innovations_[i].landmark) != nullptr)
      weigh(i, observations);
  timer.finish(PixelBlock::kWeights);
  for (std::size_t i = 0; i < observations.size(); ++i)
    if (innovations_[i].outcome == Outcome::kAdded) begin(i, observations[i]);
  timer.finish(PixelBlock::kAdd);
  correction_ = {innovations_, removed_};
  return correction_;
}

/// Decides what an observation is of: a landmark, a candidate, or something new.
void PixelSlam::sort_out(std::size_t index, const Observation& observation) {
  Innovation& innovation = innovations_[index];
  innovation.outcome = Outcome::kUnusable;
  if (!is_usable(observation)) return;
  innovation.outcome = Outcome::kUnidentified;
  if (!observation.id) return;
  innovation.landmark = *observation.id;
  const auto end = innovations_.begin() + static_cast<std::ptrdiff_t>(index);
  const bool again = std::any_of(innovations_.begin(), end, [&innovation](const Innovation& earlier) {
    return earlier.landmark == innovation.landmark && earlier.outcome != Outcome::kUnusable;
  });
  if (again)
    innovation.outcome = Outcome::kDuplicate;
  else if (map_.find(innovation.landmark) || find_candidate(innovation.landmark) != nullptr)
    innovation.outcome = Outcome::kMatched;
  else
    innovation.outcome = Outcome::kAdded;
}

/// In blocks of at most kMaxSightings: first those that agree, then those that fit what these found.
void PixelSlam::update(std::span<const Observation> observations) {
  for (std::size_t next = 0; next < observations.size();) {
    sightings_.clear();
    nus_.clear();
    seen_.clear();
    told_.clear();
    const CameraPose here = camera_pose();
    for (; next < observations.size() && sightings_.size() < ekf::State::kMaxSightings; ++next)
      if (innovations_[next].outcome == Outcome::kMatched && map_.find(innovations_[next].landmark))
        collect(next, observations[next], here);
    if (sightings_.empty()) continue;
    if (map_.state().updates_by_textbook()) {
      update_gated(observations);
    } else {
      update_agreeing(observations);
      rescue(observations);
    }
    for (std::size_t k = 0; k < seen_.size(); ++k) book(k);
  }
}

/// Linearises one sighting at the present estimate.
void PixelSlam::collect(std::size_t index, const Observation& observation, const CameraPose& here) {
  Innovation& innovation = innovations_[index];
  const auto S = settle(index, observation, here);
  if (!S) {
    innovation.outcome = Outcome::kUnusable;
    return;
  }
  const ekf::State& state = map_.state();
  const ekf::Sighting& sighting = sightings_.back();
  told_.push_back({state.pose().covariance, state.pose_correlation(sighting), *S, sighting.H_pose});
}

/// Appends a sighting to those of the block and notes its NIS. Its S, or nothing where it cannot be used.
std::optional<Eigen::Matrix2d> PixelSlam::settle(std::size_t index, const Observation& observation,
                                                 const CameraPose& here) {
  Innovation& innovation = innovations_[index];
  auto seen = sight(*map_.find(innovation.landmark), here);
  if (!seen) return std::nullopt;
  ekf::Sighting& sighting = seen->sighting;
  sighting.R = noise(observation);
  // Vincke (10)
  sighting.nu = pixel_of(observation) - seen->predicted - map_.state().expected(sighting.errors);
  const Eigen::Matrix2d S = map_.state().innovation_covariance(sighting);
  const auto nis = mahalanobis_squared<2>(sighting.nu, S);
  if (!nis) return std::nullopt;
  if (innovation.dof == 0) innovation.log_density = log_gaussian<2>(*nis, S);
  innovation.dof = 2;
  innovation.nis = *nis;
  innovation.gate = gate_;
  sightings_.push_back(sighting);
  nus_.push_back(sighting.nu);
  seen_.push_back(index);
  return S;
}

/// Those of the block that do not agree are left as gated. Where the search was so wide that something that
/// looks right is easily found, one or two say nothing, not even against themselves.
void PixelSlam::update_agreeing(std::span<const Observation> observations) {
  const auto S = map_.state().joint_innovation_covariance(sightings_);
  const auto agrees = agreement_.best(S, nus_, gate_, agreement_gate_);
  const auto count = static_cast<std::size_t>(std::ranges::count(agrees, char{1}));
  const std::size_t known = narrowest(S, agrees);
  const bool lost = count < kWitnesses && width_px2(S, known) > kFar_px * kFar_px;
  const bool convincing = !lost && (count >= kWitnesses || 2 * count > agrees.size());
  for (std::size_t k = 0; k < seen_.size(); ++k)
    if (!convincing || agrees[k] == 0)
      innovations_[seen_[k]].outcome = lost ? Outcome::kUnusable : Outcome::kGated;
  if (convincing) judge_returning(S, agrees, known);
  update_matched(observations);
}

/// A landmark that may still be anywhere when another one is known comes back after long: it leads the state
/// far, and needs others that come back with it. Where they may be very far, so many must agree on where
/// that what looks right in wrong places hardly would.
void PixelSlam::judge_returning(const ekf::State::JointCovariance& S, std::span<const char> agrees,
                                std::size_t known) {
  returning_.clear();
  double widest_px2 = 0.0;
  for (std::size_t k = 0; k < seen_.size(); ++k) {
    if (agrees[k] == 0 || k == known) continue;
    const double left_px2 = ekf::Agreement::left_of(S, k, known).trace();
    if (left_px2 <= kFar_px * kFar_px) continue;
    returning_.push_back(k);
    widest_px2 = std::max(widest_px2, left_px2);
  }
  if (returning_.size() >= kWitnesses && widest_px2 <= kWide_px * kWide_px) return;
  if (returning_.size() >= kWitnesses) {
    const auto rest = agreement_.rest(S, nus_, known, returning_);
    const auto together = return_.best(rest.S, rest.nu, gate_, agreement_gate_);
    if (return_.false_alarms(rest.S, gate_, agreement_gate_, camera_.width_px() * camera_.height_px()) <
        kFalseAlarms) {
      for (std::size_t i = 0; i < returning_.size(); ++i)
        if (together[i] == 0) innovations_[seen_[returning_[i]]].outcome = Outcome::kGated;
      return;
    }
  }
  for (const std::size_t k : returning_) innovations_[seen_[k]].outcome = Outcome::kUnusable;
}

/// As in the article: each by itself.
void PixelSlam::update_gated(std::span<const Observation> observations) {
  for (const std::size_t i : seen_)
    if (innovations_[i].nis > gate_) innovations_[i].outcome = Outcome::kGated;
  update_matched(observations);
}

/// Updates with those of the block that are still matched.
void PixelSlam::update_matched(std::span<const Observation> observations) {
  used_.clear();
  for (std::size_t k = 0; k < seen_.size(); ++k) {
    if (innovations_[seen_[k]].outcome == Outcome::kMatched) {
      sightings_[used_.size()] = sightings_[k];
      used_.push_back(seen_[k]);
    }
  }
  sightings_.resize(used_.size());
  if (apply(observations)) return;
  for (const std::size_t i : used_) innovations_[i].outcome = Outcome::kUnusable;
}

/// Updates the state with the sightings of the observations used_, linearised anew where that matters: a ray
/// of unsure depth that is seen from elsewhere (Bell and Cathey 1993). False if S is not positive definite.
bool PixelSlam::apply(std::span<const Observation> observations) {
  if (used_.empty()) return true;
  ekf::State& state = map_.state();
  if (!state.propose(sightings_)) return false;
  const bool as_published = options_.init == ekf::Initialization::kArticle || state.updates_by_textbook();
  if (state.consistency() != ekf::Consistency::kFej && !as_published)
    for (int i = 0; i < kMostIterations && relinearize(observations); ++i)
      if (!state.propose(sightings_)) return false;
  state.accept();
  return true;
}

/// Linearises the block where it would lead to. False, and nothing changed, if that is as good as linear, or
/// leads to where nothing can be seen.
bool PixelSlam::relinearize(std::span<const Observation> observations) {
  const ekf::State& state = map_.state();
  const CameraPose there_camera = camera_.pose(state.proposed_pose());
  refined_.clear();
  double change = 0.0;
  for (std::size_t k = 0; k < used_.size(); ++k) {
    const ekf::Sighting& before = sightings_[k];
    const int feature = *map_.find(innovations_[used_[k]].landmark);
    auto there = look(map_.feature(feature), there_camera,
                      [&state](int element) { return state.proposed_landmark(element); });
    if (!there) return false;
    ekf::Sighting& sighting = there->sighting;
    sighting.R = before.R;
    sighting.nu =
        pixel_of(observations[used_[k]]) - there->predicted - state.proposed_expected(sighting.errors);
    const Eigen::Vector2d bent = sighting.nu - (before.nu - state.explained(before));
    change = std::max(change, bent.dot(before.R.inverse() * bent));
    refined_.push_back(sighting);
  }
  if (change < ekf::kNegligibleChange) return false;
  for (std::size_t k = 0; k < used_.size(); ++k) sightings_[k] = state.moved_back(refined_[k]);
  return true;
}

/// High-innovation inliers: what did not agree, but fits where the others have led, if these tell its place.
void PixelSlam::rescue(std::span<const Observation> observations) {
  const CameraPose here = camera_pose();
  const std::size_t count = seen_.size();
  sightings_.clear();
  nus_.clear();
  used_.clear();
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t index = seen_[k];
    Innovation& innovation = innovations_[index];
    if (innovation.outcome != Outcome::kGated) continue;
    const double nis_before = innovation.nis;
    const auto S = settle(index, observations[index], here);
    if (!S) continue;
    seen_.pop_back();
    if (innovation.nis <= gate_ && S->trace() <= kFar_px * kFar_px) {
      innovation.outcome = Outcome::kMatched;
      used_.push_back(index);
    } else {
      sightings_.pop_back();
    }
    innovation.nis = nis_before;
  }
  if (apply(observations)) return;
  for (const std::size_t i : used_) innovations_[i].outcome = Outcome::kUnusable;
}

/// Notes of the k-th sighting of the block how useful its landmark was.
void PixelSlam::book(std::size_t k) {
  const Innovation& innovation = innovations_[seen_[k]];
  const int feature = *map_.find(innovation.landmark);
  if (innovation.outcome == Outcome::kMatched) {
    ++map_.feature(feature).observations;
    management_.matched(feature, told_[k]);
  } else if (innovation.outcome == Outcome::kGated) {
    management_.missed(feature);
  }
}

/// Rays that were seen and have become as good as linear go on as points; those that lead behind infinity go.
/// Only where they were just seen: from elsewhere any ray may look linear.
void PixelSlam::settle_rays() {
  const Eigen::Vector3d here = camera_pose().p_world_camera;
  for (const Innovation& innovation : innovations_) {
    const auto index = map_.find(innovation.landmark);
    if (innovation.outcome != Outcome::kMatched || !index || map_.feature(*index).is_point()) continue;
    const ekf::PixelMap::Feature& feature = map_.feature(*index);
    const Eigen::Vector3d ray = map_.state().landmark(feature.element);
    const double sigma = inverse_depth(*index).sigma;
    if (ray[2] + 2.0 * sigma < 0.0)
      remove(*index);
    else if (ray[2] > 0.0 &&
             linearity_index(camera_.pose(map_.anchor_pose(feature.anchor)), ray, sigma, here) < kLinear)
      map_.make_point(*index, camera_);
  }
}

/// w <- w N(z; h(rho), S(rho)) for each depth of a candidate (Vincke et al. 2012, algorithm 1).
void PixelSlam::weigh(std::size_t index, std::span<const Observation> observations) {
  const Observation& observation = observations[index];
  Candidate& candidate = *find_candidate(innovations_[index].landmark);
  const Baseline line = baseline(candidate);
  const Eigen::Matrix2d R = noise(observation);
  const Eigen::Vector2d z = pixel_of(observation);
  double least_nis = HUGE_VAL;
  ++candidate.looks;
  candidate.depths.score([&](double rho) {
    const auto at = predict_pixel(candidate, line, rho);
    if (!at) return -HUGE_VAL;
    const Eigen::Matrix2d S = at->S + R;
    const auto nis = mahalanobis_squared<2>(z - at->pixel, S);
    if (!nis) return -HUGE_VAL;
    least_nis = std::min(least_nis, *nis);
    return -0.5 * (*nis + std::log(S.determinant()));
  });
  Innovation& innovation = innovations_[index];
  innovation.outcome = least_nis <= gate_ ? Outcome::kMatched : Outcome::kGated;
  if (innovation.outcome == Outcome::kGated) return;
  candidate.depths.take();  // Vincke Algorithm 1
  ++candidate.matches;
  const auto [mean, sigma] = candidate.depths.depth();
  const bool patient = options_.init == ekf::Initialization::kArticle;
  const bool known = sigma < options_.depth_ratio * mean;
  if (candidate.matches >= (known ? options_.least_pictures : options_.most_pictures) && (known || !patient))
    accept(candidate, index, observations);
}

/// The depth of a candidate is known well enough to linearise there: it becomes a landmark.
///
/// Its particles took the errors of the robot's way since the anchor for new ones in every picture, while
/// they are nearly the same in all of them: they are too sure, and know nothing of what the depth has in
/// common with the pose. The state therefore learns the depth from the first pixel and this one, both of
/// whose poses it holds; from the particles it takes where to linearise.
void PixelSlam::accept(Candidate& candidate, std::size_t index, std::span<const Observation> observations) {
  const int anchor = std::exchange(candidate.anchor, -1);
  if (make_room()) {
    const auto [rho, sigma] = candidate.depths.inverse_depth();
    const bool as_point = options_.init == ekf::Initialization::kArticle;
    const double unsure = as_point ? sigma : std::min(kWidening * sigma, unknown_depth().sigma);
    const int feature = add_ray(candidate.id, anchor, {candidate.xy.x(), candidate.xy.y(), rho},
                                ray_covariance(candidate.xy_covariance, unsure), {}, candidate.matches + 1);
    let_wander(feature, place(map_.feature(feature)), camera_pose());
    if (as_point)
      map_.make_point(feature, camera_);
    else
      confirm(index, observations);
  } else {
    removed_.push_back(candidate.id);
  }
  map_.release(anchor);
}

/// Its index. The map must not be full.
int PixelSlam::add_ray(LandmarkId id, int anchor, const Eigen::Vector3d& ray,
                       const Eigen::Matrix3d& covariance, const ekf::ErrorTerms& errors, int observations) {
  const int index = map_.add_ray(id, anchor, ray, covariance, errors);
  management_.added();
  map_.feature(index).observations = observations;
  map_.feature(index).seen_from_m = camera_.pose(map_.anchor_pose(anchor)).p_world_camera;
  return index;
}

/// Updates the state with one sighting alone.
void PixelSlam::confirm(std::size_t index, std::span<const Observation> observations) {
  sightings_.clear();
  nus_.clear();
  seen_.clear();
  used_.assign(1, index);
  if (settle(index, observations[index], camera_pose())) static_cast<void>(apply(observations));
}

/// A pixel that nobody knows: a candidate, or at once a ray.
void PixelSlam::begin(std::size_t index, const Observation& observation) {
  Innovation& innovation = innovations_[index];
  innovation.outcome = Outcome::kMapFull;
  const auto ray = camera_.ray(pixel_of(observation));
  const bool at_once = options_.init == ekf::Initialization::kInverseDepth;
  const auto slot = std::ranges::find_if(candidates_, [](const Candidate& c) { return c.anchor < 0; });
  if (!ray || (!at_once && slot == candidates_.end())) return;
  if (!anchor_ && !free_an_anchor()) return;
  if (at_once && !make_room()) return;
  if (!anchor_) anchor_ = map_.add_anchor();
  innovation.outcome = Outcome::kAdded;
  const Eigen::Matrix2d xy_covariance = ray->dxy_dpixel * noise(observation) * ray->dxy_dpixel.transpose();
  const ekf::ErrorTerms shaken = shaken_ray(*ray);
  if (at_once) {
    const auto [rho, sigma] = unknown_depth();
    add_ray(innovation.landmark, *anchor_, {ray->xy.x(), ray->xy.y(), rho},
            ray_covariance(xy_covariance, sigma), shaken, 1);
    return;
  }
  const Eigen::Matrix2d J = shaken[0].J.topRows<2>();
  map_.hold(*anchor_);
  slot->start(innovation.landmark, *anchor_, ray->xy, xy_covariance + J * J.transpose());
}

/// What a vibration of the camera does to the (x, y) of the ray that is seen at a pixel.
ekf::ErrorTerms PixelSlam::shaken_ray(const PixelRay& ray) const {
  const Eigen::Vector3d direction = ray.xy.homogeneous();
  ekf::ErrorTerms shaken;
  if (const auto image = camera_.project(direction)) shaken = vibration(direction, image->dpixel_dpoint);
  shaken[0].J.topRows<2>() = (-ray.dxy_dpixel * shaken[0].J.topRows<2>()).eval();
  return shaken;
}

void PixelSlam::Candidate::start(LandmarkId seen, int from, const Eigen::Vector2d& ray_xy,
                                 const Eigen::Matrix2d& covariance) {
  id = seen;
  anchor = from;
  xy = ray_xy;
  xy_covariance = covariance;
  depths.restart();
  pictures = looks = matches = 0;
}

/// Inverse depth of a point that was seen once: two standard deviations span all that it may be.
ekf::DepthParticles::Spread PixelSlam::unknown_depth() const {
  const double nearest = 1.0 / options_.depth.nearest_m, farthest = 1.0 / options_.depth.farthest_m;
  return {0.5 * (nearest + farthest), 0.25 * (nearest - farthest)};
}

/// Whether there is a free anchor, if need be by settling the rays of the one whose rays are least useful of
/// those that nobody sees or needs: those of fairly sure depth as points, the others are removed.
bool PixelSlam::free_an_anchor() {
  if (map_.has_free_anchor()) return true;
  std::array<double, kMostAnchors> worth{};
  for (const Candidate& candidate : candidates_)
    if (candidate.anchor >= 0) worth[static_cast<std::size_t>(candidate.anchor)] = HUGE_VAL;
  const auto features = map_.features();
  for (int i = 0; i < static_cast<int>(features.size()); ++i)
    if (!map_.feature(i).is_point())
      worth[static_cast<std::size_t>(map_.feature(i).anchor)] +=
          management_.is_in_scan(i) ? HUGE_VAL : management_.usefulness(i);
  const auto least = std::ranges::min_element(worth);
  if (!std::isfinite(*least)) return false;
  const auto anchor = static_cast<int>(least - worth.begin());
  for (int i = static_cast<int>(features.size()) - 1; i >= 0; --i) {
    if (map_.feature(i).anchor != anchor) continue;
    const auto [rho, sigma] = inverse_depth(i);
    if (sigma < kFairlySure * rho)
      map_.make_point(i, camera_);
    else
      remove(i);
  }
  return true;
}

/// Of a ray.
ekf::DepthParticles::Spread PixelSlam::inverse_depth(int index) const {
  const int element = map_.feature(index).element;
  return {map_.state().landmark(element)[2], std::sqrt(map_.state().landmark_covariance(element)(2, 2))};
}

void PixelSlam::drop(Candidate& candidate) {
  removed_.push_back(candidate.id);
  map_.release(std::exchange(candidate.anchor, -1));
}

void PixelSlam::retire() {
  for (int i = static_cast<int>(map_.features().size()) - 1; i >= 0; --i)
    if (management_.keeps_failing(i)) remove(i);
}

/// Whether there is room for one more landmark, if need be by removing one.
bool PixelSlam::make_room() {
  if (!map_.is_full()) return true;
  const auto least_useful = management_.evicts() ? management_.least_useful() : std::nullopt;
  if (least_useful) remove(*least_useful);
  return least_useful.has_value();
}

void PixelSlam::remove(int feature) {
  removed_.push_back(map_.feature(feature).id);
  map_.remove(feature);
  management_.removed(feature);
}

PixelSlam::Candidate* PixelSlam::find_candidate(LandmarkId id) {
  const auto found = std::ranges::find_if(
      candidates_, [id](const Candidate& candidate) { return candidate.anchor >= 0 && candidate.id == id; });
  return found == candidates_.end() ? nullptr : &*found;
}

int PixelSlam::candidates() const {
  return static_cast<int>(
      std::ranges::count_if(candidates_, [](const Candidate& c) { return c.anchor >= 0; }));
}

Result<void> PixelSlam::load(const MapState& map) {
  if (auto fits = check_fits(map, 3, options_.capacity); !fits) return fits;
  if (!map_.features().empty()) return Error{"map: a filter takes one only before anything else"};
  map_.load(map);
  for (int i = 0; i < static_cast<int>(map.ids.size()); ++i) {
    ekf::PixelMap::Feature& feature = map_.feature(i);
    const auto patch = std::ranges::find(map.patches, feature.id, &LandmarkPatch::id);
    const Pose2& seen_at = patch != map.patches.end() ? patch->T_world_robot : map.T_world_robot;
    feature.seen_from_m = camera_.pose(seen_at).p_world_camera;
    feature.first_view_m = feature.seen_from_m - map_.state().landmark(feature.element);
    management_.added();
  }
  return {};
}

MapState PixelSlam::save() const {
  const ekf::State& state = map_.state();
  MapState saved;
  saved.landmark_dimension = 3;
  saved.T_world_robot = state.pose().T_world_robot;
  std::vector<int> kept;
  for (int i = 0; i < static_cast<int>(map_.features().size()); ++i)
    if (map_.feature(i).is_point() ||
        state.landmark(map_.feature(i).element)[2] > 1.0 / options_.depth.farthest_m)
      kept.push_back(i);
  const auto count = static_cast<int>(kept.size());
  Eigen::MatrixXd J = Eigen::MatrixXd::Zero(3 + 3 * count, 3 + 3 * state.landmarks());
  J.topLeftCorner<3, 3>().setIdentity();
  saved.landmarks.resize(3 * count);
  for (int k = 0; k < count; ++k) {
    const ekf::PixelMap::Feature& feature = map_.feature(kept[static_cast<std::size_t>(k)]);
    saved.ids.push_back(feature.id);
    saved.observations.push_back(feature.observations);
    const Eigen::Vector3d values = state.landmark(feature.element);
    auto J_element = J.block<3, 3>(3 + 3 * k, 3 + 3 * feature.element);
    J_element.setIdentity();
    saved.landmarks.segment<3>(3 * k) = values;
    if (feature.is_point()) continue;
    const RayPoint point = point_of_ray(camera_.pose(map_.anchor_pose(feature.anchor)), values);
    J_element = point.J_ray;
    J.block<3, 3>(3 + 3 * k, 3 + 3 * map_.anchor_element(feature.anchor)) = point.J_anchor;
    saved.landmarks.segment<3>(3 * k) = point.p_world;
  }
  saved.covariance = J * state.covariance() * J.transpose();
  saved.covariance = (0.5 * (saved.covariance + saved.covariance.transpose())).eval();
  return saved;
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
