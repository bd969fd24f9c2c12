#include "waymark/fastslam/landmark_store.hpp"

#include <algorithm>
#include <utility>

namespace waymark::fastslam {
namespace {

constexpr std::size_t kDoublesPerCacheLine = 8;

// Whole cache lines per column, an odd number of them: the same particle's entries in the five columns of a
// large set must not all fall into one cache set.
std::size_t column_stride(std::size_t particles) {
  const std::size_t lines = (particles + kDoublesPerCacheLine - 1) / kDoublesPerCacheLine;
  return (lines | 1) * kDoublesPerCacheLine;
}

}  // namespace

LandmarkStore::LandmarkStore(ParticleBlocks& blocks)
    : blocks_(blocks),
      stride_(column_stride(blocks.particles())),
      composed_(blocks.particles()),
      draft_(make_buffer()) {
  for (std::size_t g = 0; g < kGenerations; ++g)
    generations_.push_back({AlignedArray<std::int32_t>(blocks.particles())});
}

LandmarkColumns LandmarkStore::columns_of(Buffer& buffer) const {
  double* const first = buffer.data();
  return {first, first + stride_, first + 2 * stride_, first + 3 * stride_, first + 4 * stride_};
}

int LandmarkStore::add() {
  landmarks_.push_back({make_buffer(), present_});
  ++generations_[present_].landmarks;
  return size() - 1;
}

LandmarkColumns LandmarkStore::touch(int landmark) {
  Landmark& touched = landmarks_[static_cast<std::size_t>(landmark)];
  if (touched.generation != present_) move_to_present(touched);
  return columns_of(touched.buffer);
}

void LandmarkStore::move_to_present(Landmark& landmark) {
  Generation& past = generations_[landmark.generation];
  blocks_.run([&](std::size_t begin, std::size_t end) {
    for (std::size_t column = 0; column < kColumns; ++column) {
      const double* from = landmark.buffer.data() + column * stride_;
      double* to = draft_.data() + column * stride_;
      for (std::size_t i = begin; i < end; ++i) to[i] = from[past.places[i]];
    }
  });
  std::swap(landmark.buffer, draft_);
  landmark.generation = present_;
  --past.landmarks;
  ++generations_[present_].landmarks;
}

void LandmarkStore::accept(int landmark) {
  Landmark& accepted = landmarks_[static_cast<std::size_t>(landmark)];
  std::swap(accepted.buffer, draft_);
  --generations_[accepted.generation].landmarks;
  ++generations_[present_].landmarks;
  accepted.generation = present_;
}

void LandmarkStore::resample(std::span<const std::int32_t> ancestors) {
  if (free_generation() == kGenerations) empty_oldest_generation();
  for (std::size_t g = 0; g < kGenerations; ++g) {
    Generation& past = generations_[g];
    if (g == present_ || past.landmarks == 0) continue;
    for (std::size_t i = 0; i < ancestors.size(); ++i)
      composed_[i] = past.places[static_cast<std::size_t>(ancestors[i])];
    std::swap(past.places, composed_);
  }
  ++resamplings_;
  if (generations_[present_].landmarks > 0) end_present_generation(ancestors);
}

void LandmarkStore::end_present_generation(std::span<const std::int32_t> ancestors) {
  Generation& ending = generations_[present_];
  std::ranges::copy(ancestors, ending.places.data());
  ending.ended = resamplings_;
  present_ = free_generation();
}

std::size_t LandmarkStore::free_generation() const {
  for (std::size_t g = 0; g < kGenerations; ++g)
    if (g != present_ && generations_[g].landmarks == 0) return g;
  return kGenerations;
}

void LandmarkStore::empty_oldest_generation() {
  std::size_t oldest = present_ == 0 ? 1 : 0;
  for (std::size_t g = 0; g < kGenerations; ++g)
    if (g != present_ && generations_[g].ended < generations_[oldest].ended) oldest = g;
  for (Landmark& landmark : landmarks_)
    if (landmark.generation == oldest) move_to_present(landmark);
}

LandmarkGaussian LandmarkStore::at(int landmark, int particle) const {
  const Landmark& seen = landmarks_[static_cast<std::size_t>(landmark)];
  const auto own = static_cast<std::size_t>(particle);
  const auto place =
      seen.generation == present_ ? own : static_cast<std::size_t>(generations_[seen.generation].places[own]);
  const double* entry = seen.buffer.data() + place;
  return {entry[0], entry[stride_], entry[2 * stride_], entry[3 * stride_], entry[4 * stride_]};
}

}  // namespace waymark::fastslam
