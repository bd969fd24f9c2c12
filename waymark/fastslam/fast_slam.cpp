#include "waymark/fastslam/fast_slam.hpp"

#include "waymark/fastslam/landmark_forms.hpp"
#include "waymark/fastslam/map_summary.hpp"

namespace waymark {
namespace {

enum Block : std::size_t { kAssociate, kCompare, kUpdate, kEstimate, kResample, kAdd };

// Particles draw from the collected motion at the latest when its heading is this unsure: a Gaussian (x, y,
// theta) is then still a good model of it, the sagitta 1 - cos(3 sigma) being 0.4 % of the distance.
constexpr double kMaxDeferredHeadingSigma_rad = 0.5;

}  // namespace

FastSlam::Unknown::Unknown(const AssociationOptions& options, const fastslam::SensorModel& model,
                           fastslam::ParticleBlocks& blocks)
    : matcher(AssociationModel(options, model.sensor()), model, blocks),
      existence(AssociationModel(options, model.sensor()), model, blocks) {}

FastSlam::FastSlam(const FastSlamOptions& options, const LandmarkSensor& sensor, int threads)
    : completed_(sensor),
      model_(sensor, options.noise_inflation),
      belief_(options, sensor, threads),
      history_(sensor),
      gate_(options.gate, model_),
      faults_(sensor),
      update_(options, belief_.blocks),
      edges_(model_),
      resampling_(options, belief_.blocks),
      map_(options, model_) {
  if (options.unknown) unknown_.emplace(*options.unknown, model_, belief_.blocks);
}

void FastSlam::predict(const Motion& motion) {
  if (is_still(motion) || !is_finite(motion)) return;
  belief_.predict(motion);
  faults_.predict(motion);
  history_.move(motion.increment);
  const double heading_variance = belief_.pending.covariance(2, 2);
  if (heading_variance < kMaxDeferredHeadingSigma_rad * kMaxDeferredHeadingSigma_rad) return;
  BlockTimer timer(blocks_, kUpdate);
  belief_.step({});
  belief_.update_estimate();
  timer.finish(kUpdate);
}

// Numbers are those of "A step" in docs/fastslam.md.
// Francisco Figure 1
const Correction& FastSlam::correct(std::span<const Observation> observations) {
  BlockTimer timer(blocks_, kAssociate);
  history_.scan();
  belief_.landmarks.begin_scan();
  scan_.begin(completed_.of(observations));
  associate();  // 1
  correction_ = {scan_.innovations, {}};
  timer.finish(kAssociate);
  if (tells_nothing()) return correction_;

  gate();               // 1
  accept();             // 2
  resolve_ambiguous();  // 1 and 2, without identity
  timer.finish(kCompare);
  belief_.step(update_.accepted());  // 3
  weigh();                           // 4
  timer.finish(kUpdate);
  if (scan_.any(Outcome::kMatched)) belief_.update_estimate();  // 4
  timer.finish(kEstimate);
  manage_map();                   // 5
  resampling_.resample(belief_);  // 6
  timer.finish(kResample);
  initialise();  // 6
  timer.finish(kAdd);
  correction_.removed = belief_.landmarks.removed();
  return correction_;
}

/// By identity where there is one; what the set can decide without is decided after that.
void FastSlam::associate() {
  for (std::size_t i = 0; i < scan_.size(); ++i) {
    Innovation& innovation = scan_.innovations[i];
    if (const auto& id = scan_.observations[i].id) innovation.landmark = *id;
    innovation.outcome = identify(i);
    if (innovation.outcome == Outcome::kMatched)
      scan_.match(i, *belief_.landmarks.find(innovation.landmark), belief_.landmarks);
  }
  if (unknown_) unknown_->matcher.match(scan_, gate_, room(), belief_);
}

/// What is to be done with an observation as far as its identity goes.
Outcome FastSlam::identify(std::size_t index) const {
  const Observation& observation = scan_.observations[index];
  if (!fastslam::is_usable(observation)) return Outcome::kUnusable;
  if (!observation.id) return Outcome::kUnidentified;
  if (scan_.has_before(index, *observation.id)) return Outcome::kDuplicate;
  const auto landmark = belief_.landmarks.find(*observation.id);
  if (!landmark && faults_.is_distrusted(*observation.id)) return Outcome::kDistrusted;
  if (!landmark) return room() > 0 ? Outcome::kAdded : Outcome::kMapFull;
  const bool fits = fastslam::can_take(belief_.store.form(*landmark), *fastslam::kind_of(observation.value));
  return fits ? Outcome::kMatched : Outcome::kUnusable;
}

/// How many more landmarks the scan may add.
int FastSlam::room() const { return map_.room(belief_) - scan_.count(Outcome::kAdded); }

bool FastSlam::is_ambiguous(std::size_t index) const {
  return unknown_ && unknown_->matcher.is_ambiguous(index);
}

bool FastSlam::tells_nothing() const {
  return !scan_.any(Outcome::kMatched) && !scan_.any(Outcome::kAdded) &&
         !(unknown_ && unknown_->matcher.any_ambiguous());
}

/// Each observation is judged by itself, before any of them moves or weighs a particle: their order does not
/// matter.
void FastSlam::gate() {
  belief_.load_sample();
  for (std::size_t i = 0; i < scan_.size(); ++i)
    if (scan_.is(i, Outcome::kMatched)) gate_.judge(i, scan_, belief_);
  isolate_faults();
}

/// The robot's fault is mended at once, by a motion that is still to be drawn; that of landmarks when the
/// others have corrected the particles.
void FastSlam::isolate_faults() {
  faults_.review(scan_.observations, scan_.innovations, belief_.landmarks);
  if (!faults_.wants_relocation()) return;
  faults_.relocate([this] { return save(); }, pose().T_world_robot, scan_.innovations,
                   [this](const Motion& motion) {
                     belief_.has_moved = true;
                     belief_.pending = compose(belief_.pending, motion);
                     for (std::size_t i = 0; i < scan_.size(); ++i)
                       if (scan_.is(i, Outcome::kGated) || scan_.is(i, Outcome::kMatched))
                         gate_.judge(i, scan_, belief_);
                   });
}

/// A landmark that is not where the map has it is removed, and added where it is seen, unless it may be
/// anywhere.
void FastSlam::begin_anew_where_wrong(std::size_t index) {
  if (!scan_.is(index, Outcome::kGated) || !faults_.is_landmark_wrong(index)) return;
  Innovation& innovation = scan_.innovations[index];
  const auto landmark = belief_.landmarks.find(innovation.landmark);
  if (!landmark) return;
  map_.forget(*landmark, belief_);
  innovation.outcome = faults_.is_distrusted(innovation.landmark) ? Outcome::kDistrusted : Outcome::kAdded;
}

void FastSlam::accept() {
  update_.begin();
  const std::span<const fastslam::ViewEdge> edges = edges_.find(scan_, history_, belief_);
  const std::int64_t enkf_updates = update_.enkf_updates();
  for (std::size_t i = 0; i < scan_.size(); ++i) {
    if (!scan_.is(i, Outcome::kMatched)) continue;
    // What was compared before another observation moved the particles is compared again.
    if (update_.enkf_updates() != enkf_updates)
      scan_.moments[i] = gate_.compare(scan_.observations[i], scan_.landmarks[i], belief_);
    accept(i);
  }
  for (const fastslam::ViewEdge& edge : edges) accept(edge);
}

void FastSlam::accept(std::size_t index) {
  const int landmark = scan_.landmarks[index];
  update_.accept(model_.landmark_observation(scan_.observations[index], landmark, belief_), landmark,
                 update_.power(landmark, belief_), scan_.moments[index], belief_);
  belief_.observe(landmark, scan_.observations[index]);
}

void FastSlam::accept(const fastslam::ViewEdge& edge) {
  belief_.store.gather(edge.landmark);
  kernels::LandmarkObservation landmark_observation = edge.observation;
  landmark_observation.landmark = belief_.view(edge.landmark);
  belief_.load_sample();
  const fastslam::InnovationMoments moments = belief_.compare(landmark_observation);
  const double nis = moments.mean[0] * moments.mean[0] / moments.covariance()(0, 0);
  if (nis <= gate_.threshold(1)) update_.accept(landmark_observation, edge.landmark, 1.0, moments, belief_);
}

/// What the set could not decide, it may be able to when clear observations have moved it. Then each particle
/// decides.
void FastSlam::resolve_ambiguous() {
  if (!unknown_) return;
  for (const std::size_t i : unknown_->matcher.match_ambiguous(scan_, gate_, room(), belief_)) {
    gate_.judge(i, scan_, belief_);
    if (scan_.is(i, Outcome::kMatched)) accept(i);
  }
  unknown_->matcher.split(scan_, update_, belief_);
}

/// Where no particle weighs anything they begin again evenly, and the scan was of no use.
void FastSlam::weigh() {
  if (!scan_.any(Outcome::kMatched) || resampling_.normalise(belief_)) return;
  for (Innovation& innovation : scan_.innovations)
    if (innovation.outcome == Outcome::kMatched) innovation.outcome = Outcome::kUnusable;
}

void FastSlam::manage_map() {
  map_.miss(belief_);
  map_.refine(belief_);
  if (!unknown_) return;
  unknown_->existence.update(scan_, unknown_->matcher, gate_.threshold(2), belief_);
  map_.delete_false_tracks(belief_);
  map_.initialise_choices(scan_, unknown_->matcher, belief_);
}

void FastSlam::initialise() {
  for (std::size_t i = 0; i < scan_.size(); ++i) begin_anew_where_wrong(i);
  for (std::size_t i = 0; i < scan_.size(); ++i)
    if (scan_.is(i, Outcome::kAdded) && !is_ambiguous(i)) map_.initialise(i, scan_, history_, belief_);
}

Snapshot FastSlam::snapshot() const { return {{}, pose(), fastslam::summarise_landmarks(belief_)}; }

MapState FastSlam::save() const { return fastslam::summarise(belief_); }

}  // namespace waymark
