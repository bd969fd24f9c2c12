#include "waymark/fastslam/landmark_store.hpp"

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <vector>

#include <gtest/gtest.h>

#include "support/allocation_counter.hpp"
#include "waymark/core/random.hpp"

namespace waymark::fastslam {
namespace {

using kernels::LandmarkForm;
using kernels::LandmarkView;

/// All numbers of one landmark of one particle: those of its hypotheses, and its anchor.
using DeepLandmark = std::vector<float>;

std::vector<float*> columns_of(const LandmarkView& view, float* existence = nullptr) {
  std::vector<float*> columns;
  for (std::size_t k = 0; k < view.mode_count; ++k) {
    const auto& [a, b, aa, ab, bb] = view.modes[k].gaussian;
    columns.insert(columns.end(), {a, b, aa, ab, bb});
    if (view.modes[k].log_weight != nullptr) columns.push_back(view.modes[k].log_weight);
  }
  if (existence != nullptr) columns.push_back(existence);
  if (view.form != LandmarkForm::kPoint) columns.insert(columns.end(), {view.anchor_x, view.anchor_y});
  return columns;
}

/// What the store stands for: one vector of landmarks per particle, copied whole on resampling.
using DeepMaps = std::vector<std::vector<DeepLandmark>>;

/// Runs a store and its model through the same random life.
class TwinMaps {
 public:
  TwinMaps(int particles, std::uint64_t seed)
      : random_(seed, StreamPurpose::kWorld),
        blocks_(particles, 2),
        store_(blocks_),
        maps_(static_cast<std::size_t>(particles)) {}

  void add() {
    const double chance = random_.uniform();
    const LandmarkForm form = chance < 0.5   ? LandmarkForm::kPoint
                              : chance < 0.8 ? LandmarkForm::kRay
                                             : LandmarkForm::kRing;
    const int landmark =
        store_.add(form, {0.0, 0.0}, form == LandmarkForm::kRing ? 3 : 1, random_.uniform() < 0.5);
    for (auto& map : maps_) map.emplace_back();
    write(landmark);
  }

  void update() {
    const int landmark = any_landmark();
    store_.gather(landmark);
    if (store_.modes(landmark) > 1 && random_.uniform() < 0.2) {
      store_.drop_mode(landmark, 1);
    } else if (store_.form(landmark) == LandmarkForm::kRay && random_.uniform() < 0.2) {
      store_.become_point(landmark);
    }
    write(landmark);
  }

  /// The last one takes the place of the removed one.
  void remove() {
    const int landmark = any_landmark();
    store_.remove(landmark);
    for (auto& map : maps_) {
      map[static_cast<std::size_t>(landmark)] = map.back();
      map.pop_back();
    }
  }

  /// To as many particles as there are, or to fewer, or back to all.
  void resample() {
    const std::size_t count = random_.uniform() < 0.8 ? alive_ : 1 + random_index(maps_.size());
    std::vector<std::int32_t> ancestors(count);
    for (auto& ancestor : ancestors) ancestor = static_cast<std::int32_t>(random_index(alive_));
    store_.resample(ancestors);
    DeepMaps copies(maps_.size(), maps_.front());
    for (std::size_t i = 0; i < count; ++i) copies[i] = maps_[static_cast<std::size_t>(ancestors[i])];
    maps_ = copies;
    alive_ = count;
  }

  void live_one_step() {
    const double chance = random_.uniform();
    if (store_.size() == 0 || chance < 0.04)
      add();
    else if (chance < 0.05)
      remove();
    else if (chance < 0.5)
      update();
    else
      resample();
  }

  /// Looks at a copy of the store's landmarks: gathering is part of the life of the store itself.
  [[nodiscard]] bool equal() const {
    for (int k = 0; k < store_.size(); ++k)
      for (std::size_t i = 0; i < alive_; ++i)
        if (store_.at(k, static_cast<int>(i)).mean != expected(k, i)) return false;
    return true;
  }

  [[nodiscard]] bool all_columns_equal() {
    for (int k = 0; k < store_.size(); ++k) {
      store_.gather(k);
      const auto columns = columns_of(store_.view(k, {0.0, 0.0}), store_.existence(k));
      for (std::size_t i = 0; i < alive_; ++i)
        for (std::size_t c = 0; c < columns.size(); ++c)
          if (columns[c][i] != deep(i, k)[c]) return false;
    }
    return true;
  }

  LandmarkStore& store() { return store_; }

 private:
  std::size_t random_index(std::size_t size) {
    return std::min(size - 1, static_cast<std::size_t>(random_.uniform() * static_cast<double>(size)));
  }
  int any_landmark() { return static_cast<int>(random_index(static_cast<std::size_t>(store_.size()))); }
  [[nodiscard]] const DeepLandmark& deep(std::size_t particle, int landmark) const {
    return maps_[particle][static_cast<std::size_t>(landmark)];
  }
  [[nodiscard]] Eigen::Vector2d expected(int landmark, std::size_t particle) const {
    DeepLandmark copy = deep(particle, landmark);
    const std::vector<kernels::LandmarkMode> modes = modes_in(copy, store_.modes(landmark));
    LandmarkView view{store_.form(landmark)};
    view.modes = modes.data();
    view.mode_count = modes.size();
    view.anchor_x = &copy[copy.size() - 2];
    view.anchor_y = &copy[copy.size() - 1];
    return point_of(view, 0).mean;
  }
  static std::vector<kernels::LandmarkMode> modes_in(DeepLandmark& numbers, std::size_t count) {
    std::vector<kernels::LandmarkMode> modes;
    const std::size_t stride = count > 1 ? 6 : 5;
    for (std::size_t k = 0; k < count; ++k) {
      float* const first = &numbers[k * stride];
      modes.push_back({{first, first + 1, first + 2, first + 3, first + 4}, count > 1 ? first + 5 : nullptr});
    }
    return modes;
  }

  /// New numbers for all particles.
  void write(int landmark) {
    const auto columns = columns_of(store_.view(landmark, {0.0, 0.0}), store_.existence(landmark));
    for (std::size_t i = 0; i < maps_.size(); ++i) {
      DeepLandmark& numbers = maps_[i][static_cast<std::size_t>(landmark)];
      numbers.resize(columns.size());
      for (std::size_t c = 0; c < columns.size(); ++c)
        numbers[c] = columns[c][i] = static_cast<float>(random_.uniform(0.1, 1.0));
    }
  }

  RandomStream random_;
  ParticleBlocks blocks_;
  LandmarkStore store_;
  DeepMaps maps_;
  std::size_t alive_ = maps_.size();
};

TEST(LandmarkStore, EqualsDeepCopiesBitForBitOverALongRandomRun) {
  for (const int particles : {1, 7, 300}) {
    TwinMaps twins(particles, 4);
    for (int step = 0; step < 1500; ++step) {
      twins.live_one_step();
      if (step % 10 == 0) {
        ASSERT_TRUE(twins.equal()) << particles << " particles, step " << step;
      }
    }
    EXPECT_TRUE(twins.all_columns_equal());
    EXPECT_GT(twins.store().size(), 20);
  }
}

TEST(LandmarkStore, SurvivesMoreGenerationsThanItKeeps) {
  TwinMaps twins(50, 5);
  for (int k = 0; k < 60; ++k) {
    twins.add();
    twins.resample();
  }
  for (int k = 0; k < 100; ++k) twins.resample();
  EXPECT_TRUE(twins.equal());
  EXPECT_TRUE(twins.all_columns_equal());
}

TEST(LandmarkStore, ColumnsAreAligned) {
  ParticleBlocks blocks(13);
  LandmarkStore store(blocks);
  store.add(LandmarkForm::kRing, {0.0, 0.0}, 3);
  for (const float* column : columns_of(store.view(0, {0.0, 0.0})))
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(column) % 64, 0U);
}

TEST(LandmarkStore, CountsPositionsFromWhereItIsAsked) {
  ParticleBlocks blocks(1);
  LandmarkStore store(blocks);
  store.add(LandmarkForm::kPoint, {1e7, -1e7});
  const LandmarkView view = store.view(0, {1e7 - 2.0, -1e7 + 1.0});
  EXPECT_EQ(view.offset_x, 2.0F);
  EXPECT_EQ(view.offset_y, -1.0F);
  view.modes->gaussian.a[0] = 0.5F;
  view.modes->gaussian.b[0] = 0.25F;
  EXPECT_EQ(store.at(0, 0).mean, Eigen::Vector2d(1e7 + 0.5, -1e7 + 0.25));
}

TEST(LandmarkStore, AllocatesOnlyWhenALandmarkIsAdded) {
  constexpr int kParticles = 100;
  ParticleBlocks blocks(kParticles);
  LandmarkStore store(blocks);
  for (int k = 0; k < 40; ++k) store.add(k % 2 == 0 ? LandmarkForm::kPoint : LandmarkForm::kRay, {0.0, 0.0});
  std::vector<std::int32_t> ancestors(kParticles, 0);
  const test::AllocationCount count;
  for (int step = 0; step < 200; ++step) {
    store.resample(ancestors);
    store.gather(step % 40);
    if (step == 100) store.become_point(1);
  }
  EXPECT_EQ(count.allocations(), 0);
}

TEST(LandmarkStore, LandmarksThatComeAndGoAllocateNothing) {
  ParticleBlocks blocks(100);
  LandmarkStore store(blocks);
  for (int k = 0; k < 20; ++k) store.add(LandmarkForm::kPoint, {0.0, 0.0}, 1, true);
  store.remove(3);
  const test::AllocationCount count;
  for (int k = 0; k < 100; ++k) {
    store.add(LandmarkForm::kPoint, {0.0, 0.0}, 1, true);
    store.remove(k % 20);
  }
  EXPECT_EQ(count.allocations(), 0);
  EXPECT_EQ(store.size(), 19);
}

/// How many landmarks were moved by resampling alone, when each step looks at one landmark after another.
TEST(LandmarkStore, LandmarksThatNobodyLooksAtAreSeldomMoved) {
  constexpr int kLandmarks = 2000;
  ParticleBlocks blocks(16);
  LandmarkStore store(blocks);
  for (int k = 0; k < kLandmarks; ++k) store.add(LandmarkForm::kPoint, {0.0, 0.0});
  std::vector<std::int32_t> ancestors(16);
  std::iota(ancestors.begin(), ancestors.end(), 0);
  int moved = 0;
  const auto column = [&](int k) { return store.view(k, {0.0, 0.0}).modes->gaussian.a; };
  for (int step = 0; step < kLandmarks; ++step) {
    std::vector<const float*> before;
    for (int k = 0; k < kLandmarks; ++k) before.push_back(column(k));
    store.resample(ancestors);
    for (int k = 0; k < kLandmarks; ++k) moved += column(k) != before[static_cast<std::size_t>(k)] ? 1 : 0;
    store.gather(step);
  }
  // Folding the oldest generation instead would move 2000 of them every 16 steps: 250 000.
  EXPECT_LT(moved, kLandmarks * 12);
}

}  // namespace
}  // namespace waymark::fastslam
