#include "waymark/ekf/pixel_map.hpp"

#include <optional>
#include <set>
#include <utility>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "support/allocation_counter.hpp"
#include "support/matrix_near.hpp"
#include "support/poses.hpp"
#include "waymark/core/random.hpp"

namespace waymark::ekf {
namespace {

using test::matrix_near;

constexpr int kAnchors = 5;

LandmarkId corner(int number) { return {LandmarkId::Family::kCorner, number}; }

Motion random_step(RandomStream& random) {
  return {{random.uniform(0.0, 0.3), random.uniform(-0.02, 0.02), random.uniform(-0.2, 0.2)},
          test::random_covariance<3>(random, 1e-4)};
}

Eigen::Vector3d random_ray(RandomStream& random) {
  return {random.uniform(-0.5, 0.5), random.uniform(-0.4, 0.4), random.uniform(0.1, 1.0)};
}

/// A map and, in plain lists, what should be in it.
class Model {
 public:
  Model(int capacity, std::uint64_t seed)
      : random_(seed, StreamPurpose::kWorld),
        capacity_(capacity),
        map_(capacity, kAnchors, Consistency::kInvariant, 1, 1),
        anchors_(kAnchors) {}

  void step() {
    map_.state().predict(random_step(random_));
    const double what = random_.uniform();
    if (what < 0.2)
      add_anchor();
    else if (what < 0.3)
      hold();
    else if (what < 0.45)
      release();
    else if (what < 0.75)
      add_ray();
    else if (what < 0.85)
      make_point();
    else
      remove();
  }

  void expect_equal() const {
    ASSERT_EQ(map_.features().size(), features_.size());
    EXPECT_EQ(map_.is_full(), features_.size() == static_cast<std::size_t>(capacity_));
    std::set<int> elements;
    for (std::size_t i = 0; i < features_.size(); ++i) {
      expect_equal(static_cast<int>(i), features_[i]);
      elements.insert(map_.features()[i].element);
    }
    bool free = false;
    for (int a = 0; a < kAnchors; ++a) {
      free |= !at(a);
      if (!at(a)) continue;
      EXPECT_EQ(map_.anchor_pose(a), at(a)->pose);
      elements.insert(map_.anchor_element(a));
    }
    EXPECT_EQ(map_.has_free_anchor(), free);
    EXPECT_EQ(elements.size(), static_cast<std::size_t>(map_.state().landmarks()));  // each has its own
  }

 private:
  struct Feature {
    LandmarkId id;
    int anchor;
    Eigen::Vector3d values;
    Eigen::Matrix3d covariance;
  };
  struct AnchorPose {
    Pose2 pose;
    int held = 0;  ///< by this model: rays hold it besides
  };

  [[nodiscard]] const std::optional<AnchorPose>& at(int a) const {
    return anchors_[static_cast<std::size_t>(a)];
  }
  [[nodiscard]] std::optional<AnchorPose>& at(int a) { return anchors_[static_cast<std::size_t>(a)]; }

  void expect_equal(int index, const Feature& expected) const {
    const PixelMap::Feature& feature = map_.feature(index);
    EXPECT_EQ(feature.id, expected.id);
    EXPECT_EQ(feature.anchor, expected.anchor);
    EXPECT_EQ(map_.find(expected.id), index);
    EXPECT_EQ(map_.state().landmark(feature.element), expected.values);
    EXPECT_TRUE(matrix_near(map_.state().landmark_covariance(feature.element), expected.covariance, 1e-12));
  }

  [[nodiscard]] std::optional<int> any_anchor() {
    const int first = static_cast<int>(random_.uniform() * kAnchors);
    for (int k = 0; k < kAnchors; ++k)
      if (at((first + k) % kAnchors)) return (first + k) % kAnchors;
    return std::nullopt;
  }
  [[nodiscard]] std::size_t any_feature() {
    return static_cast<std::size_t>(random_.uniform() * static_cast<double>(features_.size()));
  }

  void add_anchor() {
    const bool room = map_.has_free_anchor();
    const Pose2 here = map_.state().pose().T_world_robot;
    const auto added = map_.add_anchor();
    ASSERT_EQ(added.has_value(), room);
    if (!added) return;
    EXPECT_FALSE(at(*added));
    at(*added) = {here, 1};
  }

  void hold() {
    const auto a = any_anchor();
    if (!a) return;
    map_.hold(*a);
    ++at(*a)->held;
  }

  void release() {
    const auto a = any_anchor();
    if (!a || at(*a)->held == 0) return;
    map_.release(*a);
    --at(*a)->held;
    forget(*a);
  }

  /// An anchor that nobody holds.
  void forget(int a) {
    if (at(a)->held > 0) return;
    for (const Feature& feature : features_)
      if (feature.anchor == a) return;
    at(a).reset();
  }

  void add_ray() {
    const auto a = any_anchor();
    if (!a || map_.is_full()) return;
    const Feature added{corner(next_++), *a, random_ray(random_), test::random_covariance<3>(random_, 1e-3)};
    map_.add_ray(added.id, *a, added.values, added.covariance);
    features_.push_back(added);
  }

  void make_point() {
    if (features_.empty()) return;
    const std::size_t i = any_feature();
    if (features_[i].anchor < 0) return;
    map_.make_point(static_cast<int>(i), camera_);
    const int anchor = std::exchange(features_[i].anchor, -1);
    const CameraPose then = camera_.pose(at(anchor)->pose);
    const Eigen::Vector3d ray = features_[i].values;
    features_[i].values = point_of_ray(then, ray).p_world;
    const int element = map_.feature(static_cast<int>(i)).element;
    features_[i].covariance = map_.state().landmark_covariance(element);
    EXPECT_EQ(map_.feature(static_cast<int>(i)).first_view_m, then.p_world_camera - features_[i].values);
    forget(anchor);
  }

  void remove() {
    if (features_.empty()) return;
    const std::size_t i = any_feature();
    const int anchor = features_[i].anchor;
    map_.remove(static_cast<int>(i));
    features_[i] = features_.back();
    features_.pop_back();
    if (anchor >= 0) forget(anchor);
  }

  RandomStream random_;
  int capacity_;
  Camera camera_;
  PixelMap map_;
  std::vector<Feature> features_;
  std::vector<std::optional<AnchorPose>> anchors_;
  int next_ = 0;
};

TEST(PixelMap, KeepsAccountOfItsElementsWhateverComesAndGoes) {
  for (int world = 0; world < 20 && !testing::Test::HasFailure(); ++world) {
    Model model(1 + world, static_cast<std::uint64_t>(world));
    for (int i = 0; i < 500 && !testing::Test::HasFailure(); ++i) {
      model.step();
      model.expect_equal();
    }
  }
}

TEST(PixelMap, AnAnchorLeavesWithItsLastHolder) {
  RandomStream random(1, StreamPurpose::kWorld);
  PixelMap map(4, 2, Consistency::kInvariant, 1, 0);
  const int anchor = *map.add_anchor();
  map.add_ray(corner(1), anchor, random_ray(random), 1e-3 * Eigen::Matrix3d::Identity());
  map.add_ray(corner(2), anchor, random_ray(random), 1e-3 * Eigen::Matrix3d::Identity());
  map.release(anchor);  // the rays hold it still
  EXPECT_EQ(map.state().landmarks(), 3);
  map.make_point(0, Camera());
  EXPECT_EQ(map.state().landmarks(), 3);
  map.remove(1);
  EXPECT_EQ(map.state().landmarks(), 1);
  EXPECT_TRUE(map.feature(0).is_point());
  ASSERT_TRUE(map.add_anchor());
  ASSERT_TRUE(map.add_anchor());
  EXPECT_FALSE(map.add_anchor());
}

/// Two rays of one anchor that is not where the robot is, and one of another.
void add_three_rays(PixelMap& map, RandomStream& random) {
  int number = 0;
  for (const int rays : {2, 1}) {
    map.state().predict(random_step(random));
    const int anchor = *map.add_anchor();
    for (int k = 0; k < rays; ++k)
      map.add_ray(corner(number++), anchor, random_ray(random), test::random_covariance<3>(random, 1e-3));
  }
  map.state().predict(random_step(random));
}

TEST(PixelMap, APointIsWhatItsRayAndItsAnchorSayTogether) {
  RandomStream random(2, StreamPurpose::kWorld);
  PixelMap map(4, 3, Consistency::kInvariant, 1, 1);
  add_three_rays(map, random);
  const Camera camera({.mount = {.x_m = 0.1, .z_m = 0.4, .pitch_deg = 5.0}});
  const PixelMap::Feature ray = map.feature(1);
  const auto at = [](int element) { return 3 + 3 * element; };
  const Eigen::VectorXd mean = map.state().mean();
  const Eigen::Vector3d xyr = mean.segment<3>(at(ray.element));
  const CameraPose anchor = camera.pose(map.anchor_pose(ray.anchor));
  const RayPoint point = point_of_ray(anchor, xyr);
  Eigen::MatrixXd J = Eigen::MatrixXd::Identity(mean.size(), mean.size());
  J.block<3, 3>(at(ray.element), at(ray.element)) = point.J_ray;
  J.block<3, 3>(at(ray.element), at(map.anchor_element(ray.anchor))) = point.J_anchor;
  const Eigen::MatrixXd expected = J * map.state().covariance() * J.transpose();
  Eigen::VectorXd expected_mean = mean;
  expected_mean.segment<3>(at(ray.element)) =
      anchor.p_world_camera + anchor.R_camera_world.transpose() * xyr.head<2>().homogeneous() / xyr[2];

  map.hold(ray.anchor);
  map.make_point(1, camera);
  EXPECT_TRUE(matrix_near(map.state().mean(), expected_mean, 1e-12));
  EXPECT_TRUE(matrix_near(map.state().covariance(), expected, 1e-12 * expected.cwiseAbs().maxCoeff()));
}

TEST(PixelMap, AllocatesNothingOnceItIsMade) {
  RandomStream random(3, StreamPurpose::kWorld);
  PixelMap map(4, 2, Consistency::kInvariant, 1, 0);
  const test::AllocationCount count;
  for (int k = 0; k < 3; ++k) {
    const int anchor = *map.add_anchor();
    map.add_ray(corner(k), anchor, random_ray(random), 1e-3 * Eigen::Matrix3d::Identity());
    map.release(anchor);
    if (k == 1) map.make_point(0, Camera());
    if (k == 2) map.remove(0);
  }
  EXPECT_EQ(count.allocations(), 0);
}

}  // namespace
}  // namespace waymark::ekf
