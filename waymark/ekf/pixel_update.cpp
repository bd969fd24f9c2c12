#include "waymark/ekf/pixel_update.hpp"

#include "waymark/core/chi2.hpp"
#include "waymark/core/gaussian.hpp"

namespace waymark::ekf {
namespace {

/// A bound on the work. What has not converged by then is used as it is: any of these linearisations is
/// better than the first.
constexpr int kMostIterations = 5;

/// The article linearises once.
int max_iterations(const PixelSlamOptions& options) {
  const bool as_published =
      options.init == Initialization::kArticle || options.update == UpdateMethod::kTextbook;
  return as_published ? 0 : kMostIterations;
}

}  // namespace

PixelUpdate::PixelUpdate(const PixelSlamOptions& options, BoundedMap& map, const PixelPrediction& prediction)
    : map_(map),
      prediction_(prediction),
      gate_(chi2_quantile(kPixelGateProbability, 2)),
      gates_alone_(options.update == UpdateMethod::kTextbook),
      consensus_(State::kMaxObservations, gate_,
                 prediction.camera().width_px() * prediction.camera().height_px()),
      update_(max_iterations(options), Likelihood::kGaussian, options.consistency) {
  innovations_.reserve(static_cast<std::size_t>(options.capacity));
  block_.reserve(State::kMaxObservations);
  linearizations_.reserve(State::kMaxObservations);
  nus_.reserve(State::kMaxObservations);
  pose_observations_.reserve(State::kMaxObservations);
  used_.reserve(State::kMaxObservations);
  used_observations_.reserve(State::kMaxObservations);
  if (gates_alone_) map.map().state().use_textbook_update();
}

std::span<const Innovation> PixelUpdate::update(std::span<const FoundPixel> found) {
  innovations_.assign(found.size(), {});
  for (std::size_t next = 0; next < found.size();) {
    next = collect(found, next);
    if (block_.empty()) continue;
    judge();
    update_matched(found);
    if (!gates_alone_) rescue(found);
    note_usefulness(found);
  }
  return innovations_;
}

std::optional<Innovation> PixelUpdate::confirm(const FoundPixel& found) {
  const auto compared = compare(found, prediction_.camera_pose(map_.map()));
  if (!compared) return std::nullopt;
  const Innovation confirmed = innovation(found, *compared);
  used_.assign(1, 0);
  used_observations_.assign(1, compared->linearization);
  static_cast<void>(apply({&found, 1}));
  return confirmed;
}

/// Nothing where it cannot be used.
std::optional<PixelUpdate::Compared> PixelUpdate::compare(const FoundPixel& found,
                                                          const CameraPose& here) const {
  const auto linearization = prediction_.linearize(map_.map(), found, here);
  if (!linearization) return std::nullopt;
  const Eigen::Matrix2d S = map_.map().state().innovation_covariance(*linearization);
  const auto nis = mahalanobis_squared<2>(linearization->nu, S);
  if (!nis) return std::nullopt;
  return Compared{*linearization, S, *nis};
}

Innovation PixelUpdate::innovation(const FoundPixel& found, const Compared& compared) const {
  return {.landmark = map_.map().feature(found.feature).id,
          .outcome = Outcome::kMatched,
          .dof = 2,
          .nis = compared.nis,
          .gate = gate_,
          .log_density = log_gaussian<2>(compared.nis, compared.S)};
}

/// Makes a block of the pixels from the first one on, all at the present estimate. The one behind its last.
std::size_t PixelUpdate::collect(std::span<const FoundPixel> found, std::size_t first) {
  block_.clear();
  linearizations_.clear();
  nus_.clear();
  pose_observations_.clear();
  const State& state = map_.map().state();
  const CameraPose here = prediction_.camera_pose(map_.map());
  std::size_t next = first;
  for (; next < found.size() && block_.size() < State::kMaxObservations; ++next) {
    const auto compared = compare(found[next], here);
    if (!compared) {
      innovations_[next].landmark = map_.map().feature(found[next].feature).id;
      continue;
    }
    const LinearizedObservation& linearization = compared->linearization;
    innovations_[next] = innovation(found[next], *compared);
    block_.push_back(next);
    linearizations_.push_back(linearization);
    nus_.push_back(linearization.nu);
    pose_observations_.push_back(
        {state.pose().covariance, state.pose_correlation(linearization), compared->S});
  }
  return next;
}

/// Which of the block are matched.
void PixelUpdate::judge() {
  if (gates_alone_) {
    for (const std::size_t i : block_)
      if (innovations_[i].nis > gate_) innovations_[i].outcome = Outcome::kGated;
    return;
  }
  const auto outcomes =
      consensus_.judge(map_.map().state().joint_innovation_covariance(linearizations_), nus_);
  for (std::size_t k = 0; k < block_.size(); ++k) innovations_[block_[k]].outcome = outcomes[k];
}

void PixelUpdate::update_matched(std::span<const FoundPixel> found) {
  used_.clear();
  used_observations_.clear();
  for (std::size_t k = 0; k < block_.size(); ++k) {
    if (innovations_[block_[k]].outcome != Outcome::kMatched) continue;
    used_.push_back(block_[k]);
    used_observations_.push_back(linearizations_[k]);
  }
  update_used(found);
}

/// Updates with those that were gated but fit where the others have led. Their NIS stays what it was.
void PixelUpdate::rescue(std::span<const FoundPixel> found) {
  used_.clear();
  used_observations_.clear();
  const CameraPose here = prediction_.camera_pose(map_.map());
  for (const std::size_t i : block_) {
    if (innovations_[i].outcome != Outcome::kGated) continue;
    const auto compared = compare(found[i], here);
    if (!compared || !consensus_.rescues(compared->nis, compared->S)) continue;
    innovations_[i].outcome = Outcome::kMatched;
    used_.push_back(i);
    used_observations_.push_back(compared->linearization);
  }
  update_used(found);
}

void PixelUpdate::update_used(std::span<const FoundPixel> found) {
  if (used_.empty() || apply(found)) return;
  for (const std::size_t i : used_) innovations_[i].outcome = Outcome::kUnusable;
}

/// False, and nothing changed, if S is not positive definite.
bool PixelUpdate::apply(std::span<const FoundPixel> found) {
  PixelMap& map = map_.map();
  return update_.apply(map.state(), used_observations_, [&](std::size_t k, const LinearizedObservation&) {
    return prediction_.linearize_at_proposal(map, found[used_[k]]);
  });
}

void PixelUpdate::note_usefulness(std::span<const FoundPixel> found) {
  for (std::size_t k = 0; k < block_.size(); ++k) {
    const int feature = found[block_[k]].feature;
    const Outcome outcome = innovations_[block_[k]].outcome;
    if (outcome == Outcome::kMatched)
      map_.matched(feature, pose_observations_[k]);
    else if (outcome == Outcome::kGated)
      map_.missed(feature);
  }
}

}  // namespace waymark::ekf
