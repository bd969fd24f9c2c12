#include "waymark/ekf/pixel_slam.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <map>
#include <set>
#include <span>
#include <vector>

#include <gtest/gtest.h>

#include "support/allocation_counter.hpp"
#include "support/matrix_near.hpp"
#include "support/point_room.hpp"
#include "waymark/core/gaussian.hpp"

namespace waymark {
namespace {

using test::PointRoom;

constexpr int kLap = 1390;  ///< images of one round

/// The room's pixels are as good as their covariance says, and of points that stand still.
PixelSlamOptions with_perfect_pixels(PixelSlamOptions options) {
  options.model_sigma_px = 0.15;
  options.landmark_noise_px = 0.0;
  return options;
}

/// A filter in a room of points, and what a front end would do between the two.
struct Drive {
  explicit Drive(std::uint64_t seed, const PixelSlamOptions& options = {},
                 const PointRoom::Options& kind = {})
      : room(seed, kind), start(room.truth()), filter(with_perfect_pixels(options), room.camera()) {}

  void step() {
    filter.predict(room.move());
    seen = room.search_for(filter.expect(), missed);
    note(filter.correct(seen, missed));
    std::vector<Observation> fresh = room.search_for_new(3);
    std::erase_if(fresh, [this](const Observation& each) { return gone.contains(*each.id); });
    note(filter.correct(fresh));
  }
  void run(int steps) {
    for (int i = 0; i < steps; ++i) step();
  }

  /// Keeps the account of a front end: what was taken, and is not gone.
  void note(const Correction& correction) {
    for (const Innovation& innovation : correction.innovations) {
      ++outcomes[innovation.outcome];
      if (innovation.outcome == Outcome::kAdded) known.insert(innovation.landmark);
    }
    gone = {correction.removed.begin(), correction.removed.end()};
    for (const LandmarkId id : gone) known.erase(id);
  }

  [[nodiscard]] int count(Outcome outcome) const {
    const auto found = outcomes.find(outcome);
    return found == outcomes.end() ? 0 : found->second;
  }
  [[nodiscard]] Pose2 truth() const { return start.inverse() * room.truth(); }
  [[nodiscard]] Eigen::Vector3d truth(LandmarkId id) const {
    const Eigen::Vector3d p = room.point(id.number);
    const Eigen::Vector2d ground = start.inverse() * Eigen::Vector2d(p.head<2>());
    return {ground.x(), ground.y(), p.z()};
  }
  [[nodiscard]] double nees() const {
    const auto pose = filter.pose();
    return *mahalanobis_squared<3>(difference(truth(), pose.T_world_robot), pose.covariance);
  }
  [[nodiscard]] double error_m() const {
    return (filter.pose().T_world_robot.position() - truth().position()).norm();
  }

  PointRoom room;
  Pose2 start;
  PixelSlam filter;
  std::vector<Observation> seen;
  std::vector<LandmarkId> missed;
  std::set<LandmarkId> known, gone;
  std::map<Outcome, int> outcomes;
};

/// Mean over a lap.
double lap_nees(Drive& drive) {
  constexpr int kSamples = 20;
  double sum = 0.0;
  for (int k = 0; k < kSamples; ++k) {
    drive.run(kLap / kSamples);
    sum += drive.nees();
  }
  return sum / kSamples;
}

TEST(PixelSlam, FollowsTheTruthWithinItsOwnUncertainty) {
  constexpr int kLaps = 20;
  double nees = 0.0, error_m = 0.0;
  for (std::uint64_t seed = 0; seed < kLaps; ++seed) {
    Drive drive(seed);
    const double of_this_lap = lap_nees(drive);
    EXPECT_LT(of_this_lap, 15.0) << "seed " << seed;
    EXPECT_LT(drive.error_m(), 0.15) << "seed " << seed;
    nees += of_this_lap / kLaps;
    error_m += drive.error_m() / kLaps;
  }
  // 3 if all were linear. Poses of one lap share what they got wrong: their mean scatters by about 2.
  EXPECT_GT(nees, 2.0);
  EXPECT_LT(nees, 4.5);
  EXPECT_LT(error_m, 0.04);
}

/// A patch without pixels says from where a landmark was first seen.
MapState with_views_from(MapState map, const Pose2& T_world_robot) {
  for (const LandmarkId id : map.ids) map.patches.push_back({id, T_world_robot, {}});
  return map;
}

TEST(PixelSlam, GoesOnFromASavedMap) {
  for (std::uint64_t seed = 0; seed < 4; ++seed) {
    Drive drive(seed);
    drive.run(kLap / 3);
    const MapState saved = drive.filter.save();
    ASSERT_GT(saved.ids.size(), 20U);
    PixelSlam again(with_perfect_pixels({}), drive.room.camera());
    ASSERT_TRUE(again.load(with_views_from(saved, saved.T_world_robot)));
    const MapState loaded = again.save();
    EXPECT_EQ(loaded.ids, saved.ids);
    EXPECT_EQ(loaded.landmarks, saved.landmarks);
    EXPECT_EQ(loaded.covariance, saved.covariance);
    // With the landmarks in view alone, and nothing new.
    for (int i = 0; i < 60; ++i) {
      again.predict(drive.room.move());
      const auto seen = drive.room.search_for(again.expect(), drive.missed);
      EXPECT_GT(again.correct(seen).count(Outcome::kMatched), 0) << "seed " << seed << ", image " << i;
    }
    const PoseEstimate pose = again.pose();
    EXPECT_LT(*mahalanobis_squared<3>(difference(drive.truth(), pose.T_world_robot), pose.covariance), 20.0);
    EXPECT_LT((pose.T_world_robot.position() - drive.truth().position()).norm(), 0.15);
  }
}

TEST(PixelSlam, LinearisedAtTheLatestEstimateItIsTooSure) {
  double standard = 0.0, invariant = 0.0;
  for (std::uint64_t seed = 0; seed < 4; ++seed) {
    Drive latest(seed, {.consistency = ekf::Consistency::kStandard});
    Drive fair(seed);
    standard += lap_nees(latest);
    invariant += lap_nees(fair);
  }
  EXPECT_GT(standard, 2.0 * invariant);
}

// They differ in who may take part, not in what the update is: before their choices have led them apart, by
// less than either errs.
TEST(PixelSlam, WithTheTextbookUpdateItIsTheArticlesFilter) {
  PixelSlamOptions options;
  options.init = ekf::Initialization::kArticle;
  options.capacity = 30;
  options.consistency = ekf::Consistency::kStandard;
  PixelSlamOptions slow = options;
  slow.update = UpdateMethod::kTextbook;
  double fast_error_m = 0.0, textbook_error_m = 0.0, difference_m = 0.0;
  for (std::uint64_t seed = 0; seed < 8; ++seed) {
    Drive fast(seed, options);
    Drive textbook(seed, slow);
    for (Drive* each : {&fast, &textbook}) {
      each->run(15);
      EXPECT_GT(each->count(Outcome::kMatched), 30);
      EXPECT_TRUE(is_covariance(each->filter.pose().covariance));
    }
    fast_error_m += fast.error_m();
    textbook_error_m += textbook.error_m();
    difference_m +=
        (fast.filter.pose().T_world_robot.position() - textbook.filter.pose().T_world_robot.position())
            .norm();
  }
  EXPECT_LT(difference_m, std::min(fast_error_m, textbook_error_m));
}

// A point that moves as a resting one at another distance would seem to is taken for that until its way
// shows: a few laps are too sure of themselves for it. Most are as they would be without such points.
TEST(PixelSlam, PointsThatMoveAreRefusedAndHardlyBendAnything) {
  int moving = 0, all = 0;
  double error_m = 0.0;
  std::vector<double> nees;
  constexpr int kLaps = 6;
  for (std::uint64_t seed = 0; seed < kLaps; ++seed) {
    Drive drive(seed, {}, {.moving = 0.2});
    nees.push_back(lap_nees(drive));
    error_m += drive.error_m() / kLaps;
    EXPECT_GT(drive.count(Outcome::kGated), 100);
    for (const auto& feature : drive.filter.map().features()) moving += drive.room.moves(feature.id.number);
    all += static_cast<int>(drive.filter.map().features().size());
  }
  std::ranges::sort(nees);
  EXPECT_LT(nees[kLaps / 2], 5.0);
  EXPECT_LT(error_m, 0.2);
  EXPECT_LT(moving, 0.05 * all);
}

TEST(PixelSlam, ACandidateBecomesALandmarkOnceItsDepthIsKnown) {
  Drive drive(1);
  drive.filter.predict(drive.room.move());
  ASSERT_TRUE(drive.filter.expect().empty());
  const auto first = drive.room.search_for_new(1);
  EXPECT_EQ(drive.filter.correct(first).count(Outcome::kAdded), 1);
  EXPECT_EQ(drive.filter.candidates(), 1);
  EXPECT_TRUE(drive.filter.map().features().empty());
  EXPECT_TRUE(drive.filter.snapshot().landmarks.empty());
  for (int images = 1; drive.filter.candidates() == 1; ++images) {
    ASSERT_LT(images, 30);
    drive.filter.predict(drive.room.move());
    const auto expected = drive.filter.expect();
    ASSERT_EQ(expected.size(), 1U);
    EXPECT_TRUE(expected[0].candidate);
    const auto seen = drive.room.search_for(expected, drive.missed);
    ASSERT_EQ(seen.size(), 1U);
    const Eigen::Vector2d pixel(std::get<Pixel>(seen[0].value).u_px, std::get<Pixel>(seen[0].value).v_px);
    EXPECT_LT(*mahalanobis_squared<2>(pixel - expected[0].predicted_px, expected[0].S), 20.0);
    EXPECT_EQ(drive.filter.correct(seen).count(Outcome::kMatched), 1);
    EXPECT_TRUE(drive.filter.map().features().empty() || images >= ekf::DepthInitialiser::kMinImages);
  }
  ASSERT_EQ(drive.filter.map().features().size(), 1U);
  EXPECT_EQ(drive.filter.map().features()[0].id, *first[0].id);
  EXPECT_FALSE(drive.filter.map().features()[0].is_point());
}

TEST(PixelSlam, ALandmarkThatIsMissedTooOftenLeavesAndOneThatIsMissedNowAndThenStays) {
  Drive drive(3);
  drive.run(60);
  ASSERT_GE(drive.filter.map().features().size(), 2U);
  const LandmarkId fails = drive.filter.map().features()[0].id;
  const LandmarkId falters = drive.filter.map().features()[1].id;
  for (int k = 0; k < 100 && !drive.gone.contains(fails); ++k) {
    drive.filter.predict(drive.room.move());
    auto seen = drive.room.search_for(drive.filter.expect(), drive.missed);
    std::vector<LandmarkId> missed{fails};
    if (k % 3 == 0) missed.push_back(falters);
    std::erase_if(seen, [&](const Observation& each) { return std::ranges::count(missed, *each.id) > 0; });
    drive.note(drive.filter.correct(seen, missed));
    EXPECT_EQ(drive.gone.contains(fails), !drive.filter.map().find(fails));
  }
  EXPECT_TRUE(drive.gone.contains(fails));
  EXPECT_TRUE(drive.filter.map().find(falters));
}

TEST(PixelSlam, SaysWhatLeavesAndNeverHoldsMoreThanItMay) {
  PixelSlamOptions options;
  options.capacity = 20;
  Drive drive(4, options);
  for (int i = 0; i < 600; ++i) {
    drive.step();
    std::set<LandmarkId> held;
    for (const auto& feature : drive.filter.map().features()) held.insert(feature.id);
    ASSERT_LE(held.size(), 20U);
    for (const LandmarkId id : held) ASSERT_TRUE(drive.known.contains(id));
    ASSERT_EQ(drive.known.size(), held.size() + static_cast<std::size_t>(drive.filter.candidates()));
  }
  EXPECT_GT(drive.count(Outcome::kAdded), 40);
  EXPECT_TRUE(is_covariance(drive.filter.map().state().covariance()));
}

TEST(PixelSlam, RefusesWhatItCannotUseAndSaysWhy) {
  Drive drive(5);
  drive.run(60);
  drive.filter.predict(drive.room.move());
  const auto good = drive.room.search_for(drive.filter.expect(), drive.missed);
  ASSERT_GE(good.size(), 5U);
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  const Eigen::Matrix2d identity = Eigen::Matrix2d::Identity();
  std::vector<Observation> scan(good.begin(), good.begin() + 5);
  scan[0].value = Pixel{kNan, 10.0};
  scan[1].id.reset();
  scan[2].value = Bearing{0.1};
  scan[3].covariance = kNan * identity;
  scan.push_back(good[4]);
  scan.push_back(good[0]);  // which was unusable before, so this is the first that counts
  scan.push_back({LandmarkId{LandmarkId::Family::kCorner, 9999},
                  Pixel{10.0, std::numeric_limits<double>::infinity()}, identity});
  const auto& correction = drive.filter.correct(scan);
  const std::vector<Outcome> expected{Outcome::kUnusable, Outcome::kUnidentified, Outcome::kUnusable,
                                      Outcome::kUnusable, Outcome::kMatched,      Outcome::kDuplicate,
                                      Outcome::kMatched,  Outcome::kUnusable};
  ASSERT_EQ(correction.innovations.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i)
    EXPECT_EQ(correction.innovations[i].outcome, expected[i]) << i;
  EXPECT_TRUE(is_covariance(drive.filter.map().state().covariance()));
}

TEST(PixelSlam, AMotionThatIsNoNumberAndNamesThatNobodyKnowsChangeNothing) {
  Drive drive(6);
  drive.run(60);
  const Eigen::VectorXd before = drive.filter.map().state().mean();
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  drive.filter.predict({{kNan, 0.0, 0.0}, Eigen::Matrix3d::Identity()});
  drive.filter.predict({{0.1, 0.0, 0.0}, kNan * Eigen::Matrix3d::Identity()});
  const LandmarkId nobody{LandmarkId::Family::kCorner, 9999};
  drive.filter.correct({}, {&nobody, 1});
  EXPECT_EQ(drive.filter.map().state().mean(), before);
}

TEST(PixelSlam, AStepAllocatesNothing) {
  PixelSlamOptions options;
  options.capacity = 40;
  Drive drive(8, options);
  drive.run(300);  // the map is full by now: from here on landmarks come and go
  ASSERT_TRUE(drive.filter.map().is_full());
  drive.filter.correct(std::vector<Observation>(100));  // as many as will ever come
  std::int64_t allocations = 0;
  for (int i = 0; i < 200; ++i) {
    const Motion motion = drive.room.move();
    const test::AllocationCount looking;
    drive.filter.predict(motion);
    const auto expected = drive.filter.expect();
    allocations += looking.allocations();
    const auto seen = drive.room.search_for(expected, drive.missed);
    const auto fresh = drive.room.search_for_new(3);
    const test::AllocationCount correcting;
    drive.filter.correct(seen, drive.missed);
    drive.filter.correct(fresh);
    (void)drive.filter.pose();
    allocations += correcting.allocations();
  }
  EXPECT_EQ(allocations, 0);
}

TEST(PixelSlam, SavesTheWholeBeliefAndShowsTheSame) {
  Drive drive(9);
  drive.run(200);
  const MapState saved = drive.filter.save();
  const Snapshot shown = drive.filter.snapshot();
  ASSERT_GT(saved.ids.size(), 20U);
  EXPECT_EQ(saved.landmark_dimension, 3);
  ASSERT_EQ(saved.landmarks.size(), static_cast<Eigen::Index>(3 * saved.ids.size()));
  EXPECT_TRUE(is_covariance(saved.covariance));
  EXPECT_TRUE(test::matrix_near(saved.covariance.topLeftCorner<3, 3>(), drive.filter.pose().covariance, 0.0));
  ASSERT_EQ(shown.landmarks.size(), saved.ids.size());
  double nees = 0.0;
  for (std::size_t k = 0; k < saved.ids.size(); ++k) {
    const auto at = static_cast<Eigen::Index>(3 * k);
    const Eigen::Vector3d p = saved.landmarks.segment<3>(at);
    const Eigen::Matrix3d P = saved.covariance.block<3, 3>(3 + at, 3 + at);
    EXPECT_EQ(shown.landmarks[k].id, saved.ids[k]);
    EXPECT_EQ(shown.landmarks[k].position_m, p);
    EXPECT_EQ(shown.landmarks[k].covariance, P);
    const int observations = shown.landmarks[k].observations;
    EXPECT_EQ(observations, saved.observations[k]);
    EXPECT_GE(observations, ekf::DepthInitialiser::kMinImages);
    nees += *mahalanobis_squared<3>(p - drive.truth(saved.ids[k]), P) / static_cast<double>(saved.ids.size());
  }
  EXPECT_LT(nees, 9.0);
}

TEST(PixelSlam, AnImageMayComeInSeveralParts) {
  Drive whole(10);
  Drive parts(10);
  for (int i = 0; i < 200; ++i) {
    whole.step();
    parts.filter.predict(parts.room.move());
    const auto seen = parts.room.search_for(parts.filter.expect(), parts.missed);
    parts.filter.correct({}, parts.missed);
    for (std::size_t next = 0; next < seen.size(); next += 7) {
      const std::span<const Observation> part(&seen[next], std::min<std::size_t>(7, seen.size() - next));
      EXPECT_EQ(parts.filter.correct(part).innovations.size(), part.size());
    }
    parts.filter.correct(parts.room.search_for_new(3));
  }
  EXPECT_LT(parts.nees(), 16.3);  // 99.9 %
  const double apart_m =
      (whole.filter.pose().T_world_robot.position() - parts.filter.pose().T_world_robot.position()).norm();
  EXPECT_LT(apart_m, 0.02);
}

}  // namespace
}  // namespace waymark
