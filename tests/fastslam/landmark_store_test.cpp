#include "waymark/fastslam/landmark_store.hpp"

#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#include "support/allocation_counter.hpp"
#include "waymark/core/random.hpp"
#include "waymark/fastslam/resampling.hpp"

namespace waymark::fastslam {
namespace {

bool same_bits(const LandmarkGaussian& a, const LandmarkGaussian& b) {
  return a.x == b.x && a.y == b.y && a.xx == b.xx && a.xy == b.xy && a.yy == b.yy;
}

LandmarkGaussian random_landmark(RandomStream& random) {
  return {random.normal(), random.normal(), random.uniform(), random.uniform(), random.uniform()};
}

void write(const LandmarkColumns& columns, std::size_t i, const LandmarkGaussian& m) {
  columns.x[i] = m.x;
  columns.y[i] = m.y;
  columns.xx[i] = m.xx;
  columns.xy[i] = m.xy;
  columns.yy[i] = m.yy;
}

/// What the store stands for: one vector of landmarks per particle, copied whole on resampling.
using DeepMaps = std::vector<std::vector<LandmarkGaussian>>;

/// Runs a store and its model through the same random life.
class TwinMaps {
 public:
  TwinMaps(int particles, std::uint64_t seed)
      : random_(seed, StreamPurpose::kWorld),
        blocks_(particles, 2),
        store_(blocks_),
        maps_(static_cast<std::size_t>(particles)),
        ancestors_(static_cast<std::size_t>(particles)) {}

  void add() {
    const int landmark = store_.add();
    const auto columns = store_.touch(landmark);
    for (std::size_t i = 0; i < maps_.size(); ++i) {
      maps_[i].push_back(random_landmark(random_));
      write(columns, i, maps_[i].back());
    }
  }

  void update_in_place() {
    const int landmark = any_landmark();
    const auto columns = store_.touch(landmark);
    for (std::size_t i = 0; i < maps_.size(); ++i) {
      columns.x[i] += 0.5;
      maps_[i][static_cast<std::size_t>(landmark)].x += 0.5;
    }
  }

  /// As the filter does: the new version is built beside the old one, and then taken or forgotten.
  void update_by_draft(bool take) {
    const int landmark = any_landmark();
    const auto before = store_.touch(landmark);
    const auto after = store_.draft();
    for (std::size_t i = 0; i < maps_.size(); ++i) {
      const LandmarkGaussian m = before.at(i);
      const LandmarkGaussian updated{m.x - m.y, m.y * 0.7, m.xx * 0.9, m.xy - m.xx, m.yy + 0.1};
      write(after, i, updated);
      if (take) maps_[i][static_cast<std::size_t>(landmark)] = updated;
    }
    if (take) store_.accept(landmark);
  }

  void resample() {
    std::vector<double> weights(maps_.size());
    for (double& w : weights) w = random_.uniform();
    choose_ancestors(weights, random_.uniform(), ancestors_);
    store_.resample(ancestors_);
    DeepMaps copies;
    for (const auto ancestor : ancestors_) copies.push_back(maps_[static_cast<std::size_t>(ancestor)]);
    maps_ = copies;
  }

  void live_one_step() {
    const double chance = random_.uniform();
    if (store_.size() == 0 || chance < 0.03)
      add();
    else if (chance < 0.3)
      update_in_place();
    else if (chance < 0.5)
      update_by_draft(random_.uniform() < 0.7);
    else
      resample();
  }

  [[nodiscard]] bool equal() const {
    for (std::size_t i = 0; i < maps_.size(); ++i)
      for (int k = 0; k < store_.size(); ++k)
        if (!same_bits(store_.at(k, static_cast<int>(i)), maps_[i][static_cast<std::size_t>(k)]))
          return false;
    return true;
  }

  LandmarkStore& store() { return store_; }

 private:
  int any_landmark() { return static_cast<int>(random_.uniform(0.0, store_.size())); }

  RandomStream random_;
  ParticleBlocks blocks_;
  LandmarkStore store_;
  DeepMaps maps_;
  std::vector<std::int32_t> ancestors_;
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
}

TEST(LandmarkStore, ColumnsAreAligned) {
  ParticleBlocks blocks(13);
  LandmarkStore store(blocks);
  store.add();
  const auto columns = store.touch(0);
  for (const double* column : {columns.x, columns.y, columns.xx, columns.xy, columns.yy})
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(column) % 64, 0U);
}

TEST(LandmarkStore, AllocatesOnlyWhenALandmarkIsAdded) {
  constexpr int kParticles = 100;
  ParticleBlocks blocks(kParticles);
  LandmarkStore store(blocks);
  for (int k = 0; k < 40; ++k) store.add();
  std::vector<std::int32_t> ancestors(kParticles, 0);
  const test::AllocationCount count;
  for (int step = 0; step < 200; ++step) {
    store.resample(ancestors);
    store.touch(step % 40);
    store.accept((step + 1) % 40);
  }
  EXPECT_EQ(count.allocations(), 0);
}

}  // namespace
}  // namespace waymark::fastslam
