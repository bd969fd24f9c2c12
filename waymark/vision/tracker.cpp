#include "waymark/vision/tracker.hpp"

#include <algorithm>

#include "waymark/vision/subpixel.hpp"
#include "waymark/vision/usable_image.hpp"

namespace waymark::vision {
namespace {

enum Block : std::uint8_t { kCorners, kMatch, kMatchCandidates };

/// Expectations of an image for which there is room from the beginning.
constexpr std::size_t kRoom = 256;
/// Of the frame's budget, for candidates and new corners: the same on one thread and on two.
constexpr double kBackgroundShare = 0.25;

CornerOptions with(CornerOptions options, kernels::Instructions instructions) {
  options.instructions = instructions;
  return options;
}

SearchOptions with(SearchOptions options, kernels::Instructions instructions) {
  options.instructions = options.corners.instructions = instructions;
  return options;
}

}  // namespace

Tracker::SearchWorker::SearchWorker(const TrackerOptions& options, const SearchOptions& search,
                                    const Camera& camera)
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
  search_records_.reserve(kRoom);
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
  ++counts_.images;
  counts_.unusable += !is_usable_;
  background_budget_ = background_budget();
  landmarks_.budget.start(duration_from_seconds(1e-3 * options_.budget.per_frame_ms) - background_budget_ -
                          others_);
  if (is_usable_) background_.start<&Tracker::search_in_background>(this);  // Vincke Algorithm 5
}

void Tracker::copy(std::span<const Expectation> expectations) {
  expectations_.assign(expectations.begin(), expectations.end());
  R_.assign(expectations.size(), Eigen::Matrix2d::Zero());
  appearances_.clear();
  search_records_.clear();
  features_.clear();
  candidates_under_way_ = 0;
  for (const Expectation& e : expectations_) {
    appearances_.push_back(memory_.find(e.id));
    search_records_.push_back(
        {.id = e.id, .candidate = e.candidate, .predicted_px = e.predicted_px, .S = e.S});
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

Duration Tracker::background_share() const {
  return duration_from_seconds(1e-3 * kBackgroundShare * options_.budget.per_frame_ms);
}

/// Its share of each image, and what was saved once that is enough for what was too dear before: then
/// landmarks have less.
Duration Tracker::background_budget() const {
  const Duration all = background_share() + saved_;
  return all >= candidates_.budget.refused() ? all : background_share();
}

/// A single search may be too dear for the share of one image: then what that leaves is kept for later
/// ones, up to a whole image's budget.
void Tracker::save_up() {
  const Duration whole = duration_from_seconds(1e-3 * options_.budget.per_frame_ms);
  const Duration kept = candidates_.budget.left() + (background_share() + saved_ - background_budget_);
  saved_ =
      candidates_.budget.refused() > Duration{0} ? std::min(kept, whole - background_share()) : Duration{0};
}

/// What the other thread does.
void Tracker::search_in_background() {
  background_stopwatch_.start();
  candidates_.budget.start(background_budget_);
  search_for(true, options_.new_corners.max_candidates, candidates_);
  candidates_took_ = background_stopwatch_.stop();
  background_stopwatch_.start();
  corners_ = new_corners_.find(image_, features_, candidates_under_way_, candidates_.budget);
  corners_took_ = background_stopwatch_.stop();
  candidates_.is_out_of_budget |= candidates_.budget.refused() > Duration{0};
  save_up();
}

SearchOutcome Tracker::match() {
  BlockTimer timer(blocks_, kMatch);
  if (is_usable_) search_for(false, options_.max_observed, landmarks_);
  gather(false, landmarks_);
  timer.finish(kMatch);
  return landmarks_.outcome();
}

/// Looks for the most useful of the landmarks, or candidates, that are known.
void Tracker::search_for(bool candidates, int most, SearchWorker& worker) {
  worker.prospects.clear();
  for (std::size_t k = 0; k < expectations_.size(); ++k) {
    const Expectation& e = expectations_[k];
    if (e.candidate == candidates && appearances_[k] != nullptr)
      worker.prospects.push_back({k, e.information_nats, worker.finder.expected_cost_ns(e)});
  }
  order_by_usefulness(worker.prospects);
  int tried = 0;
  for (const Prospect& prospect : worker.prospects) {
    if (tried >= most) break;
    if (!worker.budget.allows(prospect.cost_ns)) {
      worker.is_out_of_budget = true;
      break;
    }
    const std::size_t k = prospect.expectation;
    const SearchResult search_result =
        worker.finder.search_for(expectations_[k], image_, here_, *appearances_[k]);
    worker.budget.spend(search_result.cost_ns);
    tried += search_result.result != SearchRecord::Result::kNotTried;
    search_records_[k].result = search_result.result;
    search_records_[k].pixel = search_result.pixel;
    R_[k] = search_result.R;
  }
}

/// What came of them, without what learn() has been told to forget meanwhile.
void Tracker::gather(bool candidates, SearchWorker& worker) {
  worker.found.clear();
  worker.missed.clear();
  for (std::size_t k = 0; k < expectations_.size(); ++k) {
    const SearchRecord& search_record = search_records_[k];
    if (expectations_[k].candidate != candidates || search_record.result == SearchRecord::Result::kNotTried)
      continue;
    if (memory_.find(search_record.id) == nullptr) continue;
    if (search_record.result == SearchRecord::Result::kFound)
      worker.found.push_back(
          {search_record.id, Pixel{search_record.pixel.x(), search_record.pixel.y()}, R_[k]});
    if (search_record.result == SearchRecord::Result::kMissed) worker.missed.push_back(search_record.id);
  }
}

SearchOutcome Tracker::finish() {
  background_.wait();
  blocks_.record(kCorners, corners_took_);
  blocks_.record(kMatchCandidates, candidates_took_);
  counts_.out_of_budget += landmarks_.is_out_of_budget || candidates_.is_out_of_budget;
  gather(true, candidates_);
  add_new_corners();
  return candidates_.outcome();
}

void Tracker::add_new_corners() {
  for (const Corner& corner : corners_) {
    const auto reference = cut_reference(image_, corner.u, corner.v);
    if (!reference) continue;
    const LandmarkId id{LandmarkId::Family::kCorner, next_number_++};
    memory_.remember(id, *reference, T_world_robot_, here_);
    proposed_.push_back(id);
    const Eigen::Vector2d pixel(corner.u, corner.v);
    candidates_.found.push_back(
        {id, Pixel{pixel.x(), pixel.y()}, Eigen::Matrix2d::Identity() * (kMinPixelSigma * kMinPixelSigma)});
    search_records_.push_back({.id = id,
                               .candidate = true,
                               .result = SearchRecord::Result::kNew,
                               .predicted_px = pixel,
                               .pixel = pixel});
  }
  corners_ = {};
}

void Tracker::learn(const Correction& correction) {
  for (const Innovation& innovation : correction.innovations)
    if (innovation.outcome == Outcome::kAdded) std::erase(proposed_, innovation.landmark);
  for (const LandmarkId id : correction.removed) memory_.forget(id);
}

}  // namespace waymark::vision
