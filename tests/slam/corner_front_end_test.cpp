#include "waymark/slam/corner_front_end.hpp"

#include <algorithm>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "support/allocation_counter.hpp"
#include "waymark/slam/pipeline.hpp"

#include "images.hpp"
#include "workbench/run/config.hpp"

namespace waymark {
namespace {

using test::noise_image;
using test::plain_image;
using test::taken;

/// A robot with a camera: what comes out of the pipeline, step by step.
struct Robot {
  struct Seen {
    Stamp stamp;
    Pose2 dead_reckoning;
    PoseEstimate pose;
    bool image = false;
  };

  explicit Robot(const PipelineOptions& options = {})
      : pipeline(
            filter, options, {}, {}, Observe::kPixel,
            [this](const Step& step) {
              steps.push_back({step.stamp, step.dead_reckoning, step.pose, step.image != nullptr});
            },
            &front_end) {}

  /// Drives ahead at 1 m/s for `seconds` while this is seen.
  void drive(double seconds, std::vector<Event> seen) {
    pipeline.push({stamp_from_seconds(0.0), Velocity{1.0, 0.0}});
    for (Event& event : seen) pipeline.push(std::move(event));
    pipeline.push({stamp_from_seconds(seconds), Velocity{}});
    pipeline.finish();
  }

  PixelSlam filter{{}, {}};
  CornerFrontEnd front_end{filter, {}, {}, Camera(CameraOptions{}), 1};
  std::vector<Seen> steps;
  Pipeline pipeline;
};

TEST(CornerFrontEnd, LooksIntoAnImageFromWhereItWasTaken) {
  Robot robot;
  robot.drive(1.0, {taken(0.25, noise_image(1)), taken(0.75, noise_image(2))});
  ASSERT_EQ(robot.steps.size(), 4U);
  EXPECT_TRUE(robot.steps[1].image && robot.steps[2].image);
  EXPECT_NEAR(robot.steps[1].dead_reckoning.x_m, 0.25, 1e-9);
  EXPECT_NEAR(robot.steps[2].dead_reckoning.x_m, 0.75, 1e-9);
  EXPECT_EQ(robot.pipeline.counts().images, 2);
}

TEST(CornerFrontEnd, PassesOverImagesThatDoNotFitTheCamera) {
  Robot robot;
  robot.drive(1.0, {taken(0.2, nullptr), taken(0.4, std::make_shared<const GreyImage>()),
                    taken(0.6, noise_image(1, 640, 480)), taken(0.8, noise_image(1, 240, 320))});
  EXPECT_EQ(robot.pipeline.counts().misfits, 4);
  EXPECT_EQ(robot.pipeline.counts().images, 0);
  EXPECT_NEAR(robot.steps.back().pose.T_world_robot.x_m, 1.0, 1e-9);
}

TEST(CornerFrontEnd, PassesOverImagesThatComeTwice) {
  Robot robot;
  robot.drive(1.0, {taken(0.2, noise_image(1)), taken(0.2, noise_image(2)), taken(0.4, noise_image(1)),
                    taken(0.6, noise_image(3))});
  EXPECT_EQ(robot.pipeline.counts().repeats, 2);
  EXPECT_EQ(robot.pipeline.counts().images, 2);
}

TEST(CornerFrontEnd, PutsALateImageInItsPlaceAndDropsOneThatIsTooLate) {
  Robot robot({.reorder_window_s = 0.3});
  robot.drive(1.0, {taken(0.4, noise_image(1)), taken(0.2, noise_image(2)), taken(0.8, noise_image(3)),
                    taken(0.1, noise_image(4))});
  EXPECT_EQ(robot.pipeline.counts().images, 3);
  EXPECT_EQ(robot.pipeline.counts().late, 1);
  EXPECT_TRUE(std::ranges::is_sorted(robot.steps, {}, &Robot::Seen::stamp));
}

TEST(CornerFrontEnd, FindsNothingInBlackAndWhiteAndGoesOnByDeadReckoning) {
  Robot robot;
  std::vector<Event> seen;
  for (int i = 1; i < 30; ++i)
    seen.push_back(taken(i / 30.0, i % 3 == 0 ? noise_image(1) : plain_image(i % 3 == 1 ? 0 : 255)));
  robot.drive(1.0, std::move(seen));
  EXPECT_EQ(robot.pipeline.counts().images, 29);
  const PoseEstimate& end = robot.steps.back().pose;
  EXPECT_NEAR(end.T_world_robot.x_m, 1.0, 5.0 * std::sqrt(end.covariance(0, 0)) + 1e-9);
  EXPECT_TRUE(end.covariance.allFinite());
}

TEST(CornerFrontEnd, ImagesAreIgnoredWhereNobodyLooks) {
  PixelSlam filter({}, {});
  Pipeline pipeline(filter, {}, {}, {}, Observe::kPixel, [](const Step&) {});
  pipeline.push(taken(0.5, noise_image(1)));
  pipeline.finish();
  EXPECT_EQ(pipeline.counts().events, 0);
}

TEST(CornerFrontEnd, TakesNoMemoryOnceTheMapIsFull) {
  auto opened = open_input("sim:room", {{}, {"sim.speed_mps=0.2"}});
  ASSERT_TRUE(opened.ok());
  Config& config = opened->config;
  config.pixel.capacity = 20;
  PixelSlam filter(config.pixel, config.camera);
  CornerFrontEnd front_end(filter, config.tracker, config.search, Camera(config.camera), 1);
  constexpr int kImages = 240, kCounted = 120;
  std::int64_t allocations = 0, matched = 0;
  for (int i = 0; i < kImages;) {
    const auto event = opened->source->next();
    ASSERT_TRUE(event.ok() && event->has_value());
    const auto* image = std::get_if<Image>(&(**event).content);
    if (image == nullptr) continue;
    const test::AllocationCount count;
    filter.predict({Pose2{0.2 / 30.0, 0.0, 0.0}, Eigen::Vector3d(1e-8, 1e-8, 1e-8).asDiagonal()});
    matched += front_end.see(*image->pixels).count(Outcome::kMatched);
    if (++i > kImages - kCounted) allocations += count.allocations();
  }
  EXPECT_EQ(allocations, 0);
  EXPECT_GT(matched, kImages);
}

}  // namespace
}  // namespace waymark
