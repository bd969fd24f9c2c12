#include "waymark/vision/tracker.hpp"

#include <algorithm>
#include <set>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <gtest/gtest.h>

#include "support/allocation_counter.hpp"

#include "known_points.hpp"
#include "squares.hpp"
#include "workbench/config/camera_keys.hpp"

namespace waymark::vision {
namespace {

constexpr double kWall_m = 2.77;  // a pixel there is a centimetre wide
const Eigen::Matrix2d kS = 9.0 * Eigen::Matrix2d::Identity();

/// The camera in front of a wall: a step to the left of a centimetre shifts the image by a pixel.
struct Wall {
  explicit Wall(std::uint64_t seed)
      : random(seed, StreamPurpose::kWorld), wall(test::squares(500, 240, random)) {}

  static Pose2 pose(int step) { return {0.0, 0.01 * step, 0.0}; }
  /// With noise that is another one in every image.
  GreyImage frame(int step) {
    GreyImage image(320, 240);
    for (int v = 0; v < 240; ++v)
      for (int u = 0; u < 320; ++u)
        image(u, v) = static_cast<std::uint8_t>(wall(u + 90 - step, v) + std::lround(2.0 * random.normal()));
    return image;
  }
  std::optional<Eigen::Vector3d> point_at(const Eigen::Vector2d& pixel, int step) const {
    const CameraPose from = camera.pose(pose(step));
    const Eigen::Vector3d ray = camera.ray(pixel)->xy.homogeneous();
    return from.p_world_camera + kWall_m * from.R_camera_world.transpose() * ray;
  }

  RandomStream random;
  GreyImage wall;
  Camera camera;
};

/// What was seen in both rounds of an image of which the filter takes nothing.
struct Rounds {
  std::vector<Observation> found, found_later;
  std::vector<LandmarkId> missed, missed_later;
};

Rounds track(Tracker& tracker, const GreyImage& image, std::span<const Expectation> expectations) {
  Rounds rounds;
  tracker.track(image, Wall::pose(0), expectations, [&](Round round, const SearchOutcome& seen) {
    const bool first = round == Round::kLandmarks;
    (first ? rounds.found : rounds.found_later).assign(seen.found.begin(), seen.found.end());
    (first ? rounds.missed : rounds.missed_later).assign(seen.missed.begin(), seen.missed.end());
    return Correction{};
  });
  return rounds;
}

/// A tracker that has begun to know the wall.
struct Started {
  explicit Started(std::uint64_t seed, const TrackerOptions& options = {}, int threads = 1)
      : wall(seed), tracker(options, {}, wall.camera, threads), points(wall.camera) {
    for (int k = 0; k < 12; ++k) see(0);
  }

  /// One image from expectations to what is learnt. Returns what was found and missed, of both kinds.
  std::vector<Observation> see(int step, bool candidates = false) {
    image = wall.frame(step);
    expectations = points.expect(Wall::pose(step), kS, wall.random, candidates);
    std::vector<Observation> found;
    std::vector<Innovation> innovations;
    missed.clear();
    tracker.track(image, Wall::pose(step), expectations, [&](Round round, const SearchOutcome& seen) {
      found.insert(found.end(), seen.found.begin(), seen.found.end());
      missed.insert(missed.end(), seen.missed.begin(), seen.missed.end());
      if (round == Round::kCandidates)
        innovations = points.take(seen, [&](const auto& pixel) { return wall.point_at(pixel, step); });
      return Correction{innovations, {}};
    });
    return found;
  }

  Wall wall;
  Tracker tracker;
  test::KnownPoints points;
  GreyImage image;
  std::vector<Expectation> expectations;
  std::vector<LandmarkId> missed;
};

int number_of(std::span<const SearchRecord> search_records, SearchRecord::Result result) {
  return static_cast<int>(std::ranges::count(search_records, result, &SearchRecord::result));
}

TEST(Tracker, FindsLandmarksAgainWhereTheyAre) {
  for (const bool candidates : {false, true}) {
    Started s(1, {.new_corners = {.max_candidates = 100}});
    const std::size_t known = s.points.size();
    ASSERT_GE(known, 12U);
    int found = 0, expected = 0;
    for (int step = 1; step < 30; ++step) {
      for (const Observation& seen : s.see(step, candidates)) {
        const auto truth = s.points.pixel(*seen.id, Wall::pose(step));
        ASSERT_TRUE(truth);
        const Eigen::Vector2d error = test::place_of(seen) - *truth;
        EXPECT_LT(error.norm(), 0.3) << seen.id->number;
        EXPECT_LT(error.dot(seen.covariance->inverse() * error), 20.0);
        ++found;
      }
      expected += static_cast<int>(s.expectations.size());
    }
    EXPECT_GT(found, expected * 9 / 10);
  }
}

TEST(Tracker, NamesEveryNewCornerAnew) {
  Started s(2);
  std::set<LandmarkId> ids;
  for (const SearchRecord& search_record : s.tracker.search_records())
    EXPECT_TRUE(ids.insert(search_record.id).second);
  // Also where the map knows corners that the tracker does not.
  const std::vector<Expectation> foreign{{.id = {LandmarkId::Family::kCorner, 5000}}};
  Tracker fresh({}, {}, s.wall.camera, 1);
  const Rounds rounds = track(fresh, s.image, foreign);
  EXPECT_TRUE(rounds.found.empty());
  ASSERT_FALSE(rounds.found_later.empty());
  EXPECT_TRUE(rounds.missed_later.empty());
  for (const Observation& seen : rounds.found_later) EXPECT_GT(seen.id->number, 5000);
}

TEST(Tracker, ForgetsWhatTheFilterDidNotTakeOrDropped) {
  Wall wall(3);
  Tracker tracker({}, {}, wall.camera, 1);
  const GreyImage image = wall.frame(0);
  test::KnownPoints points(wall.camera);
  std::vector<Innovation> innovations;
  std::vector<LandmarkId> removed;
  tracker.track(image, Wall::pose(0), {}, [&](Round, const SearchOutcome& seen) {
    for (const Observation& corner : seen.found) {
      points.add(*corner.id, *wall.point_at(test::place_of(corner), 0));
      innovations.push_back({*corner.id, innovations.empty() ? Outcome::kMapFull : Outcome::kAdded});
    }
    if (innovations.size() > 1) removed = {innovations[1].landmark};
    return Correction{innovations, removed};
  });
  ASSERT_EQ(innovations.size(), 4U);
  const Rounds second = track(tracker, image, points.expect(Wall::pose(0), kS, wall.random));
  EXPECT_EQ(second.found.size(), 2U);
  EXPECT_TRUE(second.missed.empty());
}

TEST(Tracker, DoesNotReportWhatWasDroppedMeanwhile) {
  Started s(4);
  const auto candidates = s.points.expect(Wall::pose(0), kS, s.wall.random, true);
  const std::vector<LandmarkId> removed{candidates.front().id};
  std::vector<LandmarkId> found;
  s.tracker.track(s.image, Wall::pose(0), candidates, [&](Round, const SearchOutcome& seen) {
    for (const Observation& each : seen.found) found.push_back(*each.id);
    return Correction{{}, removed};
  });
  EXPECT_FALSE(found.empty());
  for (const LandmarkId& id : found) EXPECT_NE(id, removed.front());
}

TEST(Tracker, MissesWhatIsNoLongerThere) {
  Started s(5);
  Wall other(99);
  const GreyImage image = other.frame(0);
  const auto expectations = s.points.expect(Wall::pose(0), kS, s.wall.random);
  EXPECT_GT(track(s.tracker, image, expectations).missed.size(), expectations.size() * 8 / 10);
}

TEST(Tracker, TakesAnImageThatShowsNothingForNoEvidence) {
  Started s(6);
  const auto expectations = s.points.expect(Wall::pose(0), kS, s.wall.random);
  GreyImage dark(320, 240, 3);
  const std::vector<GreyImage> useless{GreyImage(320, 240, 0), GreyImage(320, 240, 255), dark,
                                       GreyImage(160, 120, 90), GreyImage()};
  for (const GreyImage& image : useless) {
    const Rounds rounds = track(s.tracker, image, expectations);
    EXPECT_TRUE(rounds.found.empty() && rounds.found_later.empty());
    EXPECT_TRUE(rounds.missed.empty() && rounds.missed_later.empty());
    EXPECT_EQ(number_of(s.tracker.search_records(), SearchRecord::Result::kNotTried),
              static_cast<int>(expectations.size()));
  }
  EXPECT_EQ(s.tracker.counts().unusable, static_cast<std::int64_t>(useless.size()));
  EXPECT_GT(s.see(0).size(), 5U);  // landmarks return when seen
}

TEST(Tracker, SurvivesExpectationsThatAreNoNumbers) {
  Started s(7);
  auto expectations = s.points.expect(Wall::pose(0), kS, s.wall.random);
  const double nan = std::nan("");
  expectations[0].predicted_px = {nan, 5.0};
  expectations[1].S = nan * kS;
  expectations[2].information_nats = nan;
  expectations[3].p_world_m.setConstant(nan);
  expectations[4].predicted_px = {1e12, -1e12};
  expectations[5].S.setZero();
  EXPECT_GE(track(s.tracker, s.image, expectations).found.size(), expectations.size() - 7);
}

TEST(Tracker, LooksForTheMostUsefulFirstAndStopsWithItsBudget) {
  Started s(8);
  auto expectations = s.points.expect(Wall::pose(0), kS, s.wall.random);
  for (std::size_t k = 0; k < expectations.size(); ++k)
    expectations[k].information_nats = 1.0 + static_cast<double>(k * 7 % expectations.size());
  std::ranges::sort(expectations, std::greater(), &Expectation::information_nats);
  const Duration all = duration_from_seconds(0.75 * 33e-3);
  std::int64_t before = s.tracker.counts().out_of_budget;
  for (const int left_us : {0, 10, 50, 100, 200, 5000}) {
    s.tracker.leave_time(all - std::chrono::microseconds(left_us));
    track(s.tracker, s.image, std::vector(expectations.rbegin(), expectations.rend()));
    std::vector<SearchRecord> search_records(s.tracker.search_records().begin(),
                                             s.tracker.search_records().begin() + std::ssize(expectations));
    std::ranges::reverse(search_records);
    const int tried =
        static_cast<int>(search_records.size()) - number_of(search_records, SearchRecord::Result::kNotTried);
    for (int k = 0; k < tried; ++k)
      EXPECT_NE(search_records[static_cast<std::size_t>(k)].result, SearchRecord::Result::kNotTried);
    // 520 windows each
    EXPECT_NEAR(tried, std::min(left_us / 28, static_cast<int>(search_records.size())), 2) << left_us;
    const bool is_left_out = tried < std::ssize(search_records);
    EXPECT_EQ(s.tracker.counts().out_of_budget - before, is_left_out ? 1 : 0);
    before = s.tracker.counts().out_of_budget;
  }
}

TEST(Tracker, SavesUpForASearchThatIsTooDearForOneImage) {
  TrackerOptions options;
  options.budget.per_frame_ms = 0.04;  // a quarter of it is 10 us of work, a cell of an image takes some 30
  Started s(11, options);
  EXPECT_GT(s.points.expect(Wall::pose(0), kS, s.wall.random).size(), 0U);
  EXPECT_LE(s.points.expect(Wall::pose(0), kS, s.wall.random).size(), 4U);
  EXPECT_GT(s.tracker.counts().out_of_budget, 0);
}

TEST(Tracker, LooksForNoMoreThanItMay) {
  Started s(9, {.max_observed = 5});
  const auto found = s.see(0);
  EXPECT_EQ(std::ranges::count_if(s.tracker.search_records(),
                                  [](const SearchRecord& search_record) {
                                    return search_record.result == SearchRecord::Result::kFound ||
                                           search_record.result == SearchRecord::Result::kMissed;
                                  }),
            5);
  EXPECT_LE(found.size(), 5U + 4U);
}

/// All that a run through some images says.
std::vector<double> transcript(const TrackerOptions& options, int threads) {
  Started s(10, options, threads);
  std::vector<double> all;
  for (int step = 0; step < 20; ++step) {
    for (const Observation& seen : s.see(step * 2, step % 3 == 1)) {
      all.push_back(seen.id->number);
      all.push_back(test::place_of(seen).x());
      all.push_back(test::place_of(seen).y());
      all.push_back(seen.covariance->sum());
    }
    for (const LandmarkId id : s.missed) all.push_back(id.number);
  }
  return all;
}

TEST(Tracker, SeesTheSameOnOneThreadAndOnTwo) {
  const TrackerOptions options{.budget = {.per_frame_ms = 0.4}};  // which leaves something out
  EXPECT_EQ(transcript(options, 1), transcript(options, 2));
}

TEST(Tracker, SeesTheSameInScalarCode) {
  EXPECT_EQ(transcript({}, 1), transcript({.instructions = kernels::Instructions::kScalar}, 1));
}

TEST(Tracker, OfTheArticleMatchesWholePixelsOfPatchesAsTheyWereCut) {
  Started s(11,
            {.finder = {.warp = false, .subpixel = false}, .instructions = kernels::Instructions::kScalar});
  int found = 0;
  for (const Observation& seen : s.see(7)) {
    const Eigen::Vector2d place = test::place_of(seen);
    EXPECT_EQ(place, place.array().round().matrix());
    if (const auto truth = s.points.pixel(*seen.id, Wall::pose(7))) {
      EXPECT_LT((place - *truth).norm(), 0.8);
      ++found;
    }
  }
  EXPECT_GT(found, 8);
}

TEST(Tracker, AllocatesNothingOnEitherThread) {
  for (const int threads : {1, 2}) {
    Started s(12, {}, threads);
    std::vector<GreyImage> images;
    std::vector<std::vector<Expectation>> expectations;
    for (int step = 0; step < 10; ++step) {
      images.push_back(s.wall.frame(step));
      expectations.push_back(s.points.expect(Wall::pose(step), kS, s.wall.random));
      for (std::size_t k = 0; k < 4; ++k) expectations.back()[k].candidate = true;
      expectations.back()[0].S *= 100.0;  // searched at corners
      expectations.back().pop_back();     // new corners are wanted
    }
    std::vector<Innovation> taken;
    taken.reserve(100);
    const test::AllocationCount count;
    for (std::size_t k = 0; k < images.size(); ++k) {
      s.tracker.track(images[k], Wall::pose(static_cast<int>(k)), expectations[k],
                      [&](Round, const SearchOutcome& seen) {
                        EXPECT_FALSE(seen.found.empty());
                        taken.clear();
                        for (const Observation& each : seen.found)
                          taken.push_back({*each.id, Outcome::kAdded});
                        return Correction{taken, {}};
                      });
    }
    EXPECT_EQ(count.allocations(), 0) << threads;
  }
}

TEST(TrackerOptions, AreSetByKeys) {
  TrackerOptions options;
  Schema schema;
  describe(schema, options);
  for (const char* assignment :
       {"tracker.wanted=12", "tracker.budget=clock", "tracker.frame_budget_ms=5", "corners.threshold=9"})
    EXPECT_TRUE(schema.set_assignment(assignment, "here").ok()) << assignment;
  EXPECT_EQ(options.new_corners.wanted, 12);
  EXPECT_EQ(options.budget.kind, BudgetKind::kClock);
  EXPECT_EQ(options.budget.per_frame_ms, 5.0);
  EXPECT_EQ(options.corners.threshold, 9);
  TrackerOptions again;
  Schema other;
  describe(other, again);
  EXPECT_TRUE(other.load_text(schema.to_yaml(), "yaml").ok());
}

TEST(Tracker, FollowsPatchesOfEverySize) {
  for (const int patch_px : {8, 9, 11, 13, 16}) {
    Started s(13, {.finder = {.patch_px = patch_px}});
    EXPECT_GT(s.see(4).size(), 8U) << patch_px;
  }
}

TEST(Tracker, WatchesTheClock) {
  Started s(14, {.budget = {.kind = BudgetKind::kClock}});
  const auto expectations = s.points.expect(Wall::pose(0), kS, s.wall.random);
  const auto found_in = [&](Duration others) {
    s.tracker.leave_time(others);
    return track(s.tracker, s.image, expectations).found.size();
  };
  EXPECT_GT(found_in(Duration{0}), expectations.size() / 2);  // 25 ms are plenty
  EXPECT_EQ(found_in(std::chrono::milliseconds(30)), 0U);
}

}  // namespace
}  // namespace waymark::vision
