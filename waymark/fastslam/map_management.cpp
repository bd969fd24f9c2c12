#include "waymark/fastslam/map_management.hpp"

#include <algorithm>
#include <limits>

namespace waymark::fastslam {
namespace {

using kernels::LandmarkForm;
using kernels::LandmarkMeasurement;

// Whether a landmark may become a point is asked at every so many observations of it.
constexpr int kObservationsPerRefinement = 4;

/// Observations whose new landmarks are initialised after those of the particles' choices.
int count_unambiguous_new(const Scan& scan, const ParticleMatcher& matcher) {
  int count = 0;
  for (std::size_t i = 0; i < scan.size(); ++i)
    count += scan.is(i, Outcome::kAdded) && !matcher.is_ambiguous(i) ? 1 : 0;
  return count;
}

}  // namespace

MapManagement::MapManagement(const FastSlamOptions& options, const SensorModel& model)
    : model_(model), capacity_(options.capacity) {}

void MapManagement::initialise(std::size_t index, Scan& scan, const ViewHistory& history, Belief& belief) {
  const Observation& observation = scan.observations[index];
  if (observation.id)
    initialise_named(observation, history, belief);
  else
    scan.innovations[index].landmark = initialise_without_identity(observation, belief);
}

void MapManagement::initialise_named(const Observation& observation, const ViewHistory& history,
                                     Belief& belief) {
  const LandmarkMeasurement z = seen_first(observation, belief);
  const FirstForm first = first_form(z, model_.sensor(), history);
  const int landmark = belief.add({.id = *observation.id}, first.form, first.modes, observation);
  place(landmark, z, first.guess, belief);
  if (belief.store.form(landmark) != LandmarkForm::kPoint) unresolved_.push_back(landmark);
}

/// A point whose existence is in doubt.
LandmarkId MapManagement::initialise_without_identity(const Observation& observation, Belief& belief) {
  const LandmarkId id = belief.landmarks.unused_id();
  const int landmark = belief.add({.id = id, .identity = Identity::kUnknown, .existence = {}},
                                  LandmarkForm::kPoint, 1, observation);
  place(landmark, seen_first(observation, belief), {}, belief);
  std::fill_n(belief.store.existence(landmark), belief.particles.count(), 0.0F);
  return id;
}

void MapManagement::initialise_choices(Scan& scan, const ParticleMatcher& matcher, Belief& belief) {
  const int reserved = count_unambiguous_new(scan, matcher);
  for (const Association::Choice& choice : matcher.choices()) {
    if (choice.landmark != GreedyMatch::kNothing) continue;
    const std::span<const float> takers(choice.column, as_index(belief.particles.count()));
    if (std::ranges::none_of(takers, [](float t) { return t != 0.0F; })) continue;
    const auto index = as_index(choice.observation);
    if (room(belief) <= reserved) {
      if (scan.is(index, Outcome::kAdded)) scan.innovations[index].outcome = Outcome::kMapFull;
      continue;
    }
    const LandmarkId id = initialise_without_identity(scan.observations[index], belief);
    if (scan.landmarks[index] == Scan::kNone) scan.innovations[index].landmark = id;
    float* const log_odds = belief.store.existence(belief.store.size() - 1);
    for (std::size_t i = 0; i < takers.size(); ++i)
      if (takers[i] == 0.0F) log_odds[i] = kernels::kAbsent;
  }
}

/// After a distance at which nothing is left of the bias of an earlier observation.
LandmarkMeasurement MapManagement::seen_first(const Observation& observation, const Belief& belief) const {
  return model_.seen(observation, std::numeric_limits<double>::infinity(), belief.calibration.columns());
}

void MapManagement::place(int landmark, const LandmarkMeasurement& seen, const kernels::FirstGuess& guess,
                          Belief& belief) const {
  const kernels::LandmarkObservation landmark_observation{seen, model_.mount(), belief.view(landmark)};
  belief.run_with_sensors(model_.mount(), [&](const auto& sensors, const auto& range) {
    kernels::place_landmark(landmark_observation, guess, sensors, range);
  });
}

void MapManagement::miss(Belief& belief) const {
  const double detected = model_.sensor().detection_probability;
  if (!(detected > 0.0)) return;
  for (const int k : unresolved_) {
    if (belief.store.modes(k) == 1 || belief.landmarks.is_claimed(k)) continue;
    belief.store.gather(k);
    const kernels::LandmarkObservation landmark_observation{{}, model_.mount(), belief.view(k)};
    belief.run_with_sensors(model_.mount(), [&](const auto& sensors, const auto& range) {
      kernels::miss_modes(landmark_observation, detected, sensors, range);
    });
  }
}

void MapManagement::refine(Belief& belief) {
  for (const int k : unresolved_) {
    if (belief.store.modes(k) > 1) {
      belief.store.gather(k);
      tidy_modes(belief.store, k, belief.particles, belief.blocks);
    }
    const bool is_due = belief.landmarks[k].observations % kObservationsPerRefinement == 0;
    if (is_due && belief.landmarks.is_observed(k))
      become_point_if_linear(belief.store, k, belief.particles, model_.mount(), belief.blocks);
  }
  std::erase_if(unresolved_, [&](int k) { return belief.store.form(k) == LandmarkForm::kPoint; });
}

void MapManagement::delete_false_tracks(Belief& belief) {
  for (int k = belief.store.size() - 1; k >= 0; --k) {
    if (belief.records[as_index(k)].existence_probability > 0.0 && !belief.landmarks.is_stale(k)) continue;
    forget(k, belief);
  }
}

void MapManagement::forget(int landmark, Belief& belief) {
  std::erase(unresolved_, landmark);
  belief.remove(landmark);
  std::ranges::replace(unresolved_, belief.store.size(), landmark);
}

}  // namespace waymark::fastslam
