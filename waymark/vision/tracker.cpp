#include "waymark/vision/tracker.hpp"

#include <algorithm>
#include <utility>

#include "waymark/vision/subpixel.hpp"
#include "waymark/vision/usable_picture.hpp"

namespace waymark::vision {
namespace {

enum Block : std::uint8_t { kCorners, kMatch, kMatchCandidates };

/// Expectations of a picture for which there is room from the beginning.
constexpr std::size_t kRoom = 256;
/// Of the frame's budget, for candidates and new corners: the same on one thread and on two.
constexpr double kShareBehind = 0.25;

CornerOptions with(CornerOptions options, kernels::Instructions instructions) {
  options.instructions = instructions;
  return options;
}

SearchOptions with(SearchOptions options, kernels::Instructions instructions) {
  options.instructions = options.corners.instructions = instructions;
  return options;
}

}  // namespace

Tracker::Seeker::Seeker(const TrackerOptions& options, const SearchOptions& search, const Camera& camera)
    : finder(options.finder, with(search, options.instructions), camera), budget(options.budget.kind) {
  prospects.reserve(kRoom);
  found.reserve(kRoom);
  missed.reserve(kRoom);
}

Tracker::Tracker(const TrackerOptions& options, const SearchOptions& search, const Camera& camera,
                 int threads)
    : options_(options),
      grey_sigma_(search.grey_sigma),
      camera_(camera),
      memory_(options.finder.patch_px),
      new_corners_(options.new_corners, with(options.corners, options.instructions), options.finder.patch_px,
                   camera.width_px(), camera.height_px()),
      landmarks_(options, search, camera),
      candidates_(options, search, camera),
      background_(threads > 1) {
  expectations_.reserve(kRoom);
  appearances_.reserve(kRoom);
  R_.reserve(kRoom);
  looks_.reserve(kRoom);
  features_.reserve(kRoom);
  proposed_.reserve(kRoom);
}

void Tracker::begin(const ImageView& image, const Pose2& T_world_robot,
                    std::span<const Expectation> expectations) {
  background_.wait();
  for (const LandmarkId id : proposed_) memory_.forget(id);
  proposed_.clear();
  image_ = image;
  T_world_robot_ = T_world_robot;
  here_ = camera_.pose(T_world_robot);
  copy(expectations);
  corners_ = {};
  corners_took_ = candidates_took_ = Duration{0};
  landmarks_.is_out_of_budget = candidates_.is_out_of_budget = false;
  is_usable_ = is_usable(image, camera_.width_px(), camera_.height_px(), grey_sigma_);
  ++counts_.pictures;
  counts_.unusable += !is_usable_;
  behind_ = budget_behind();
  landmarks_.budget.start(duration_from_seconds(1e-3 * options_.budget.per_frame_ms) - behind_ - others_);
  if (is_usable_) background_.start<&Tracker::look_behind>(this);  // Vincke Algorithm 5
}

void Tracker::copy(std::span<const Expectation> expectations) {
  expectations_.assign(expectations.begin(), expectations.end());
  R_.assign(expectations.size(), Eigen::Matrix2d::Zero());
  appearances_.clear();
  looks_.clear();
  features_.clear();
  candidates_under_way_ = 0;
  for (const Expectation& e : expectations_) {
    appearances_.push_back(memory_.find(e.id));
    looks_.push_back({.id = e.id, .candidate = e.candidate, .predicted_px = e.predicted_px, .S = e.S});
    if (appearances_.back() != nullptr && camera_.sees(e.predicted_px)) features_.push_back(e.predicted_px);
    candidates_under_way_ += e.candidate;
    avoid(e.id);
  }
}

/// Never a number that is in use, also where the map came from elsewhere.
void Tracker::avoid(LandmarkId id) {
  if (id.family == LandmarkId::Family::kCorner) next_number_ = std::max(next_number_, id.number + 1);
}

void Tracker::remember(std::span<const LandmarkPatch> patches) {
  for (const LandmarkPatch& patch : patches) {
    ReferencePatch reference;
    if (patch.pixels.size() != reference.pixels.size()) continue;
    std::ranges::copy(patch.pixels, reference.pixels.begin());
    memory_.remember(patch.id, reference, patch.T_world_robot, camera_.pose(patch.T_world_robot));
    avoid(patch.id);
  }
}

Duration Tracker::share_behind() const {
  return duration_from_seconds(1e-3 * kShareBehind * options_.budget.per_frame_ms);
}

/// Its share of each picture, and what was saved once that is enough for what was too dear before: then
/// landmarks have less.
Duration Tracker::budget_behind() const {
  const Duration all = share_behind() + saved_;
  return all >= candidates_.budget.refused() ? all : share_behind();
}

/// A single search may be too dear for the share of one picture: then what that leaves is kept for later
/// ones, up to a whole picture's budget.
void Tracker::save_up() {
  const Duration whole = duration_from_seconds(1e-3 * options_.budget.per_frame_ms);
  const Duration kept = candidates_.budget.left() + (share_behind() + saved_ - behind_);
  saved_ = candidates_.budget.refused() > Duration{0} ? std::min(kept, whole - share_behind()) : Duration{0};
}

/// What the other thread does.
void Tracker::look_behind() {
  stopwatch_behind_.start();
  candidates_.budget.start(behind_);
  look_for(true, options_.new_corners.most_candidates, candidates_);
  candidates_took_ = stopwatch_behind_.stop();
  stopwatch_behind_.start();
  corners_ = new_corners_.find(image_, features_, candidates_under_way_, candidates_.budget);
  corners_took_ = stopwatch_behind_.stop();
  candidates_.is_out_of_budget |= candidates_.budget.refused() > Duration{0};
  save_up();
}

Sightings Tracker::match() {
  BlockTimer timer(blocks_, kMatch);
  if (is_usable_) look_for(false, options_.most_observed, landmarks_);
  gather(false, landmarks_);
  timer.finish(kMatch);
  return landmarks_.sightings();
}

/// Looks for the most useful of the landmarks, or candidates, that are known.
void Tracker::look_for(bool candidates, int most, Seeker& seeker) {
  seeker.prospects.clear();
  for (std::size_t k = 0; k < expectations_.size(); ++k) {
    const Expectation& e = expectations_[k];
    if (e.candidate == candidates && appearances_[k] != nullptr)
      seeker.prospects.push_back({k, e.information_nats, seeker.finder.expected_cost_ns(e)});
  }
  order_by_usefulness(seeker.prospects);
  int tried = 0;
  for (const Prospect& prospect : seeker.prospects) {
    if (tried >= most) break;
    if (!seeker.budget.allows(prospect.cost_ns)) {
      seeker.is_out_of_budget = true;
      break;
    }
    const std::size_t k = prospect.expectation;
    const Finding finding = seeker.finder.look_for(expectations_[k], image_, here_, *appearances_[k]);
    seeker.budget.spend(finding.cost_ns);
    tried += finding.result != Look::Result::kNotTried;
    looks_[k].result = finding.result;
    looks_[k].pixel = finding.pixel;
    R_[k] = finding.R;
  }
}

/// What came of them, without what learn() has been told to forget meanwhile.
void Tracker::gather(bool candidates, Seeker& seeker) {
  seeker.found.clear();
  seeker.missed.clear();
  for (std::size_t k = 0; k < expectations_.size(); ++k) {
    const Look& look = looks_[k];
    if (expectations_[k].candidate != candidates || look.result == Look::Result::kNotTried) continue;
    if (memory_.find(look.id) == nullptr) continue;
    if (look.result == Look::Result::kFound)
      seeker.found.push_back({look.id, Pixel{look.pixel.x(), look.pixel.y()}, R_[k]});
    if (look.result == Look::Result::kMissed) seeker.missed.push_back(look.id);
  }
}

Sightings Tracker::finish() {
  background_.wait();
  blocks_.record(kCorners, corners_took_);
  blocks_.record(kMatchCandidates, candidates_took_);
  counts_.out_of_budget += landmarks_.is_out_of_budget || candidates_.is_out_of_budget;
  gather(true, candidates_);
  add_new_corners();
  return candidates_.sightings();
}

void Tracker::add_new_corners() {
  for (const Corner& corner : corners_) {
    const auto reference = cut_reference(image_, corner.u, corner.v);
    if (!reference) continue;
    const LandmarkId id{LandmarkId::Family::kCorner, next_number_++};
    memory_.remember(id, *reference, T_world_robot_, here_);
    proposed_.push_back(id);
    const Eigen::Vector2d pixel(corner.u, corner.v);
    candidates_.found.push_back({id, Pixel{pixel.x(), pixel.y()},
                                 Eigen::Matrix2d::Identity() * (kLeastPixelSigma * kLeastPixelSigma)});
    looks_.push_back(
        {.id = id, .candidate = true, .result = Look::Result::kNew, .predicted_px = pixel, .pixel = pixel});
  }
  corners_ = {};
}

void Tracker::learn(const Correction& correction) {
  for (const Innovation& innovation : correction.innovations)
    if (innovation.outcome == Outcome::kAdded) std::erase(proposed_, innovation.landmark);
  for (const LandmarkId id : correction.removed) memory_.forget(id);
}

}  // namespace waymark::vision
