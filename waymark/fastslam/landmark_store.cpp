#include "waymark/fastslam/landmark_store.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "waymark/kernels/gather.hpp"

namespace waymark::fastslam {

using kernels::LandmarkForm;
using kernels::LandmarkMode;

LandmarkStore::LandmarkStore(ParticleBlocks& blocks)
    : blocks_(blocks), pool_(blocks.capacity()), ancestors_(blocks.capacity()), composed_(blocks.capacity()) {
  for (std::size_t g = 0; g < kGenerations; ++g)
    generations_.push_back({AlignedArray<std::int32_t>(blocks.capacity())});
  pool_.reserve(kColumnsAtOnce);
}

/// With room for one, if a removed landmark left any.
std::vector<LandmarkMode> LandmarkStore::empty_modes() {
  std::vector<LandmarkMode> modes;
  if (spare_modes_.empty()) return modes;
  modes = std::move(spare_modes_.back());
  spare_modes_.pop_back();
  return modes;
}

int LandmarkStore::add(LandmarkForm form, const Eigen::Vector2d& origin_m, std::size_t modes, bool doubtful) {
  LandmarkColumns landmark{form, origin_m, empty_modes(), nullptr, nullptr, nullptr, present_};
  for (std::size_t k = 0; k < modes; ++k) {
    LandmarkMode& mode = landmark.modes.emplace_back();
    mode.gaussian = {pool_.take(), pool_.take(), pool_.take(), pool_.take(), pool_.take()};
    if (modes > 1) mode.log_weight = pool_.take();
  }
  if (form != LandmarkForm::kPoint) {
    landmark.anchor_x = pool_.take();
    landmark.anchor_y = pool_.take();
  }
  if (doubtful) landmark.existence = pool_.take();
  landmarks_.push_back(std::move(landmark));
  spare_modes_.reserve(landmarks_.capacity());
  ++generations_[present_].landmarks;
  list_columns(landmarks_.back());  // room for the list is taken here, not when the landmark is gathered
  pool_.reserve(kColumnsAtOnce);
  return size() - 1;
}

void LandmarkStore::remove(int landmark) {
  LandmarkColumns& removed = of(landmark);
  list_columns(removed);
  for (float** column : columns_) pool_.give_back(*column);
  --generations_[removed.generation].landmarks;
  removed.modes.clear();
  spare_modes_.push_back(std::move(removed.modes));
  if (landmark != size() - 1) removed = std::move(landmarks_.back());
  landmarks_.pop_back();
}

void LandmarkStore::list_columns(LandmarkColumns& landmark) {
  columns_.clear();
  for (LandmarkMode& mode : landmark.modes) {
    auto& [a, b, aa, ab, bb] = mode.gaussian;
    columns_.insert(columns_.end(), {&a, &b, &aa, &ab, &bb});
    if (mode.log_weight != nullptr) columns_.push_back(&mode.log_weight);
  }
  if (landmark.anchor_x != nullptr) columns_.insert(columns_.end(), {&landmark.anchor_x, &landmark.anchor_y});
  if (landmark.existence != nullptr) columns_.push_back(&landmark.existence);
}

/// The listed columns, through `places`: a few at a time, so that few columns have to be spare.
void LandmarkStore::gather_columns(const std::int32_t* places) {
  std::array<float*, kColumnsAtOnce> gathered{};
  for (std::size_t first = 0; first < columns_.size(); first += kColumnsAtOnce) {
    const std::size_t count = std::min(kColumnsAtOnce, columns_.size() - first);
    for (std::size_t c = 0; c < count; ++c) gathered[c] = pool_.take();
    blocks_.run([&](std::size_t begin, std::size_t end) {
      for (std::size_t c = 0; c < count; ++c)
        kernels::gather(*columns_[first + c], places + begin, gathered[c] + begin, end - begin);
    });
    for (std::size_t c = 0; c < count; ++c) pool_.give_back(std::exchange(*columns_[first + c], gathered[c]));
  }
}

void LandmarkStore::gather(int landmark) {
  if (of(landmark).generation != present_) move_to_present(of(landmark));
}

void LandmarkStore::move_to_present(LandmarkColumns& landmark) {
  Generation& past = generations_[landmark.generation];
  list_columns(landmark);
  gather_columns(past.places.data());
  landmark.generation = present_;
  --past.landmarks;
  ++generations_[present_].landmarks;
}

kernels::LandmarkView LandmarkStore::view(int landmark, const Eigen::Vector2d& origin_m) const {
  const LandmarkColumns& seen = of(landmark);
  const Eigen::Vector2f offset = (seen.origin_m - origin_m).cast<float>();
  return {seen.form,     offset.x(),        offset.y(),       seen.anchor_x,
          seen.anchor_y, seen.modes.data(), seen.modes.size()};
}

void LandmarkStore::drop_mode(int landmark, std::size_t mode) {
  auto& modes = of(landmark).modes;
  auto& [a, b, aa, ab, bb] = modes[mode].gaussian;
  for (float* column : {a, b, aa, ab, bb, modes[mode].log_weight}) pool_.give_back(column);
  modes.erase(modes.begin() + static_cast<std::ptrdiff_t>(mode));
  if (modes.size() == 1) pool_.give_back(std::exchange(modes.front().log_weight, nullptr));
}

void LandmarkStore::become_point(int landmark) {
  LandmarkColumns& changed = of(landmark);
  changed.form = LandmarkForm::kPoint;
  pool_.give_back(std::exchange(changed.anchor_x, nullptr));
  pool_.give_back(std::exchange(changed.anchor_y, nullptr));
}

void LandmarkStore::resample(std::span<const std::int32_t> ancestors) {
  if (free_generation() == kGenerations) fold_young_generations();
  blocks_.resize(ancestors.size());
  std::ranges::copy(ancestors, ancestors_.data());
  for (std::size_t g = 0; g < kGenerations; ++g) {
    Generation& past = generations_[g];
    if (g == present_ || past.landmarks == 0) continue;
    blocks_.run([&](std::size_t begin, std::size_t end) {
      kernels::gather(past.places.data(), ancestors_.data() + begin, composed_.data() + begin, end - begin);
    });
    std::swap(past.places, composed_);
  }
  ++resamplings_;
  if (generations_[present_].landmarks > 0) end_present_generation();
}

void LandmarkStore::end_present_generation() {
  Generation& ending = generations_[present_];
  std::swap(ending.places, ancestors_);
  ending.ended = resamplings_;
  present_ = free_generation();
}

std::size_t LandmarkStore::free_generation() const {
  for (std::size_t g = 0; g < kGenerations; ++g)
    if (g != present_ && generations_[g].landmarks == 0) return g;
  return kGenerations;
}

/// Generations that ended then or later hold, each, at most as many landmarks as all younger ones together.
std::int64_t LandmarkStore::first_to_fold() const {
  std::array<const Generation*, kGenerations> young{};
  std::size_t count = 0;
  for (std::size_t g = 0; g < kGenerations; ++g)
    if (g != present_) young[count++] = &generations_[g];
  std::sort(young.begin(), young.begin() + static_cast<std::ptrdiff_t>(count),
            [](const Generation* a, const Generation* b) { return a->ended > b->ended; });
  int folded = young[0]->landmarks;
  std::size_t last = 0;
  while (last + 1 < count && young[last + 1]->landmarks <= folded) folded += young[++last]->landmarks;
  return young[last]->ended;
}

void LandmarkStore::fold_young_generations() {
  const std::int64_t since = first_to_fold();
  for (LandmarkColumns& landmark : landmarks_)
    if (landmark.generation != present_ && generations_[landmark.generation].ended >= since)
      move_to_present(landmark);
}

PointGaussian LandmarkStore::at(int landmark, int particle) const {
  const LandmarkColumns& seen = of(landmark);
  const auto own = static_cast<std::size_t>(particle);
  const auto place =
      seen.generation == present_ ? own : static_cast<std::size_t>(generations_[seen.generation].places[own]);
  PointGaussian point = point_of(view(landmark, seen.origin_m), place);
  point.mean += seen.origin_m;
  return point;
}

}  // namespace waymark::fastslam
