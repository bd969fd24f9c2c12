#include "workbench/datasets/plaza.hpp"

#include <cmath>

#include <gmock/gmock.h>

#include "support/data_dir.hpp"
#include "support/io_support.hpp"
#include "waymark/core/angle.hpp"

#include "datasets/mat_support.hpp"

namespace waymark {
namespace {

using test::only;
using test::TempFolder;
using testing::Contains;
using testing::HasSubstr;

/// A robot that goes 1 m ahead and then turns left on an arc.
std::string mat_run(const Eigen::MatrixXd& ranges) {
  const Eigen::MatrixXd truth{{10.0, 1.0, 2.0, 0.0}, {11.0, 2.0, 2.0, 0.0}, {12.0, 3.0, 2.1, 0.1}};
  const Eigen::MatrixXd odometry{{11.0, 1.0, 0.0}, {12.0, 1.0, 0.1}};
  const Eigen::MatrixXd beacons{{0.0, -5.0, 6.0}, {5.0, 7.0, 8.0}};
  return test::mat_header() + test::mat_variable("GT", truth) + test::mat_variable("DR", odometry) +
         test::mat_variable("TD", ranges) + test::mat_variable("TL", beacons);
}

const Eigen::MatrixXd kRanges{{10.5, 2.0, 5.0, 6.5}, {10.25, 2.0, 0.0, 7.5}};

std::unique_ptr<Source> open_plaza(const TempFolder& folder, const std::string& bytes,
                                   const std::string& name = "Plaza7_.mat", bool fix = true) {
  const auto file = MatFile::open(folder.write(name, bytes));
  EXPECT_TRUE(file.ok()) << file.error().message;
  EXPECT_TRUE(is_plaza(*file));
  auto source = open_plaza(*file, fix);
  EXPECT_TRUE(source.ok()) << source.error().message;
  return *std::move(source);
}

TEST(Plaza, SumsOdometryUpAlongArcsFromTheFirstTruth) {
  const TempFolder folder;
  const auto source = open_plaza(folder, mat_run(kRanges));
  EXPECT_EQ(source->info().name, "Plaza7");
  const auto events = test::read_all(*source).events;
  const auto poses = only<OdometryPose>(events);
  ASSERT_EQ(poses.size(), 3U);
  EXPECT_EQ(poses[0].first, parse_stamp("10"));
  EXPECT_EQ(poses[0].second.T_odom_robot, Pose2{});
  EXPECT_NEAR(poses[1].second.T_odom_robot.x_m, 1.0, 1e-12);
  EXPECT_NEAR(poses[2].second.T_odom_robot.x_m, 1.0 + std::cos(0.05), 1e-12);
  EXPECT_NEAR(poses[2].second.T_odom_robot.y_m, std::sin(0.05), 1e-12);
  EXPECT_NEAR(poses[2].second.T_odom_robot.theta_rad, 0.1, 1e-12);
}

TEST(Plaza, RangesKeepTheirBeaconAndComeInTheOrderOfTime) {
  const TempFolder folder;
  const auto source = open_plaza(folder, mat_run(kRanges));
  const auto ranges = only<Observations>(test::read_all(*source).events);
  ASSERT_EQ(ranges.size(), 2U);
  EXPECT_EQ(ranges[0].first, parse_stamp("10.25"));
  EXPECT_EQ(ranges[0].second[0].id, (LandmarkId{LandmarkId::Family::kMarker, 0}));
  EXPECT_EQ(std::get<Range>(ranges[0].second[0].value).range_m, 7.5);
  EXPECT_THAT(source->notes(), Contains("ranges sorted by time: 1"));
  EXPECT_THAT(source->info().settings, Contains(std::pair<std::string, std::string>("observe", "range")));
  ASSERT_EQ(source->info().landmarks.size(), 2U);
  EXPECT_EQ(source->info().landmarks[1].id.number, 5);
}

TEST(Plaza, RobotThatDrivesBackwardsGoesNegativeDistances) {
  const TempFolder folder;
  const auto fixed = open_plaza(folder, mat_run(kRanges), "Plaza2_.mat");
  EXPECT_NEAR(only<OdometryPose>(test::read_all(*fixed).events)[1].second.T_odom_robot.x_m, -1.0, 1e-12);
  EXPECT_THAT(fixed->notes(), Contains(HasSubstr("drives backwards")));
  const auto as_published = open_plaza(folder, mat_run(kRanges), "Plaza2_.mat", false);
  EXPECT_NEAR(only<OdometryPose>(test::read_all(*as_published).events)[1].second.T_odom_robot.x_m, 1.0,
              1e-12);
  folder.write("Plaza2_DR.txt", "11 1 0\n12 1 0.1\n");
  folder.write("Plaza2_TD.txt", "10.5 2 5 6.5\n");
  const auto text = open_plaza_text(plaza_text_runs(folder.path()).at(0), true).value();
  EXPECT_NEAR(only<OdometryPose>(test::read_all(*text).events)[1].second.T_odom_robot.x_m, -1.0, 1e-12);
}

TEST(Plaza, TextFilesGiveTheSameRunWithoutTruth) {
  const TempFolder folder;
  folder.write("Plaza7_DR.txt", "  1.1000000000000000e+001\t  1.0\t 0.0\t\n 12 1 0.1\n");
  folder.write("Plaza7_TD.txt", "  1.0500e+001\t 2 \t 5\t 6.5\t\n 10.25 2 0 7.5\n");
  const auto runs = plaza_text_runs(folder.path());
  ASSERT_EQ(runs.size(), 1U);
  const auto text = open_plaza_text(runs[0], true).value();
  const auto mat = open_plaza(folder, mat_run(kRanges));
  EXPECT_EQ(text->info().name, "Plaza7");
  const auto text_events = test::read_all(*text).events;
  const auto mat_events = test::read_all(*mat).events;
  const auto a = only<OdometryPose>(text_events);
  const auto b = only<OdometryPose>(mat_events);
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].first, b[i].first);
    EXPECT_EQ(a[i].second.T_odom_robot, b[i].second.T_odom_robot);
  }
  EXPECT_EQ(only<Observations>(text_events).size(), 2U);
  EXPECT_TRUE(only<Truth>(text_events).empty());
}

TEST(Plaza, ImpossibleRowsAreNamed) {
  const TempFolder folder;
  const auto error_of = [&folder](const Eigen::MatrixXd& ranges) {
    const auto file = MatFile::open(folder.write("x.mat", mat_run(ranges))).value();
    return open_plaza(file, true).error().message;
  };
  EXPECT_THAT(error_of(Eigen::MatrixXd{{10.0, 2.0, 5.0, -1.0}}),
              HasSubstr("x.mat: TD: row 1: a range cannot be negative"));
  EXPECT_THAT(error_of(Eigen::MatrixXd{{1e10, 2.0, 5.0, 1.0}}), HasSubstr("TD: row 1: is not a time"));
  EXPECT_THAT(error_of(Eigen::MatrixXd{{10.0, 2.0, 1e9, 1.0}}), HasSubstr("is not the number of a beacon"));
  EXPECT_THAT(error_of(Eigen::MatrixXd::Zero(2, 3)), HasSubstr("variable TD has 3 columns; expected 4"));
}

struct RecordedRun {
  const char* file;
  std::size_t truth;
  std::size_t ranges;
  double final_error_m;  ///< of dead reckoning from the true start
};

class PlazaRecording : public testing::TestWithParam<RecordedRun> {};

TEST_P(PlazaRecording, HoldsTheKnownCountsAndDeadReckonsAsKnown) {
  const RecordedRun& known = GetParam();
  WAYMARK_REQUIRE_DATA(known.file);
  const auto file = MatFile::open(test::data_path(known.file));
  ASSERT_TRUE(file.ok()) << file.error().message;
  const auto source = open_plaza(*file, true).value();
  const auto events = test::read_all(*source).events;
  const auto truth = only<Truth>(events);
  const auto odometry = only<OdometryPose>(events);
  EXPECT_EQ(truth.size(), known.truth);
  EXPECT_EQ(only<Observations>(events).size(), known.ranges);
  ASSERT_EQ(odometry.size(), known.truth);
  const Pose2 start{truth[0].second.x_m, truth[0].second.y_m, *truth[0].second.theta_rad};
  const Pose2 end = start * odometry.back().second.T_odom_robot;
  EXPECT_NEAR(std::hypot(end.x_m - truth.back().second.x_m, end.y_m - truth.back().second.y_m),
              known.final_error_m, 0.01);
}

INSTANTIATE_TEST_SUITE_P(Plaza, PlazaRecording,
                         testing::Values(RecordedRun{"plaza/Plaza1_.mat", 9658, 3529, 4.45},
                                         RecordedRun{"plaza/Plaza2_.mat", 4091, 1816, 19.90}),
                         [](const auto& run) { return "Run" + std::to_string(run.index + 1); });

}  // namespace
}  // namespace waymark
