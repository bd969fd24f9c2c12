#include "waymark/ekf/iterated_pixel_update.hpp"

#include <algorithm>

#include <Eigen/LU>

#include "waymark/ekf/negligible_change.hpp"

namespace waymark::ekf {
namespace {

/// A bound on the work. What has not converged by then is used as it is: any of these linearisations is
/// better than the first.
constexpr int kMostIterations = 5;

int max_iterations(const PixelSlamOptions& options) {
  const bool as_published =
      options.init == Initialization::kArticle || options.update == UpdateMethod::kTextbook;
  return options.consistency == Consistency::kFej || as_published ? 0 : kMostIterations;
}

}  // namespace

IteratedPixelUpdate::IteratedPixelUpdate(const PixelSlamOptions& options, const PixelPrediction& prediction)
    : prediction_(prediction), max_iterations_(max_iterations(options)) {
  found_.reserve(State::kMaxObservations);
  linearizations_.reserve(State::kMaxObservations);
  refined_.reserve(State::kMaxObservations);
}

void IteratedPixelUpdate::clear() {
  found_.clear();
  linearizations_.clear();
}

void IteratedPixelUpdate::add(const FoundPixel& found, const LinearizedObservation& linearization) {
  found_.push_back(found);
  linearizations_.push_back(linearization);
}

bool IteratedPixelUpdate::apply(PixelMap& map) {
  if (linearizations_.empty()) return true;
  State& state = map.state();
  if (!state.propose(linearizations_)) return false;
  for (int i = 0; i < max_iterations_ && relinearize(map); ++i)
    if (!state.propose(linearizations_)) return false;
  state.accept();
  return true;
}

/// Linearises where the proposal leads. False, and nothing changed, if that is as good as linear, or leads to
/// where nothing can be seen.
bool IteratedPixelUpdate::relinearize(const PixelMap& map) {
  const State& state = map.state();
  const CameraPose there = prediction_.camera().pose(state.proposed_pose());
  refined_.clear();
  double change = 0.0;
  for (std::size_t k = 0; k < linearizations_.size(); ++k) {
    const LinearizedObservation& before = linearizations_[k];
    const auto linearization = prediction_.linearize_at_proposal(map, found_[k], there);
    if (!linearization) return false;
    const Eigen::Vector2d bent = linearization->nu - (before.nu - state.explained(before));
    change = std::max(change, bent.dot(before.R.inverse() * bent));
    refined_.push_back(*linearization);
  }
  if (change < kNegligibleChange) return false;
  for (std::size_t k = 0; k < linearizations_.size(); ++k)
    linearizations_[k] = state.relinearized_to_prior(refined_[k]);
  return true;
}

}  // namespace waymark::ekf
