#include "workbench/datasets/victoria_park_graph.hpp"

#include <cmath>

#include <gmock/gmock.h>

#include "support/data_dir.hpp"
#include "support/io_support.hpp"

#include "datasets/mat_support.hpp"

namespace waymark {
namespace {

using test::only;
using test::TempFolder;
using testing::HasSubstr;

constexpr const char* kGraph =
    "ODOMETRY 0 1 1 0 0 1e-4 0 0 4e-6 0 4e-6\n"
    "LANDMARK 1 2 6.78 4.5 0.4 0 0.4\n"
    "ODOMETRY 1 3 0.5 0 1.5707963267948966 1e-4 0 0 4e-6 0 4e-6\n"
    "ODOMETRY 3 4 2 0 0 1e-4 0 0 4e-6 0 4e-6\n";

TEST(VictoriaParkGraph, PosesAddUpAndTreesAreSeenFromTheLaser) {
  const TempFolder folder;
  const auto file = folder.write("victoria_park.txt", kGraph);
  EXPECT_TRUE(is_victoria_park_graph(file));
  const auto source = open_victoria_park_graph(file).value();
  const auto events = test::read_all(*source).events;
  const auto poses = only<OdometryPose>(events);
  ASSERT_EQ(poses.size(), 4U);
  EXPECT_NEAR(poses[3].second.T_odom_robot.x_m, 1.5, 1e-12);
  EXPECT_NEAR(poses[3].second.T_odom_robot.y_m, 2.0, 1e-12);
  EXPECT_EQ(poses[3].first, stamp_from_seconds(0.6));
  const auto seen = only<Observations>(events);
  ASSERT_EQ(seen.size(), 1U);
  EXPECT_EQ(seen[0].first, poses[1].first);
  EXPECT_EQ(seen[0].second[0].id->number, 2);
  const auto z = std::get<RangeBearing>(seen[0].second[0].value);
  EXPECT_NEAR(z.range_m, 5.0, 1e-12);
  EXPECT_NEAR(z.bearing_rad, std::atan2(4.0, 3.0), 1e-12);
  EXPECT_TRUE(source->info().identities);
}

TEST(VictoriaParkGraph, TimesAreThoseOfTheScansAtWhichTheLogHadGoneAsFar) {
  const TempFolder folder;
  const Eigen::MatrixXd none = Eigen::MatrixXd::Zero(3, 0);
  Eigen::MatrixXd scans(1, 6);
  scans << 9.0, 10.0, 11.0, 11.5, 12.0, 14.0;  // at 0, 0, 1, 1.5, 2 and 4 m
  folder.write("VictoriaParkSinSincronizar.mat",
               test::mat_header() + test::mat_variable("time", Eigen::MatrixXd{{10.0, 20.0}}) +
                   test::mat_variable("u", Eigen::MatrixXd{{1.0, 1.0}, {0.0, 0.0}}) +
                   test::mat_variable("TLsr", scans) +
                   test::mat_cells("zt", std::vector<Eigen::MatrixXd>(6, none)));
  const auto source = open_victoria_park_graph(folder.write("victoria_park.txt", kGraph)).value();
  std::vector<double> times_s;
  for (const auto& [stamp, pose] : only<OdometryPose>(test::read_all(*source).events))
    times_s.push_back(to_seconds(stamp));
  EXPECT_THAT(times_s, testing::ElementsAre(9.0, 11.0, 11.5, 14.0));
}

TEST(VictoriaParkGraph, BadLinesAreNamed) {
  const TempFolder folder;
  const auto error_of = [&folder](const std::string& line) {
    return open_victoria_park_graph(folder.write("victoria_park.txt", line)).error().message;
  };
  EXPECT_THAT(error_of("EDGE 1 2\n"), HasSubstr("victoria_park.txt:1: 'EDGE' is not a known kind of line"));
  EXPECT_THAT(error_of("ODOMETRY 0 1 1 0 0\n"), HasSubstr(":1: expected 11 numbers after ODOMETRY"));
  EXPECT_THAT(error_of("LANDMARK 0 x\n"), HasSubstr("'x' is not a number"));
  EXPECT_THAT(error_of("ODOMETRY 5 6 1 0 0 0 0 0 0 0 0\n"), HasSubstr("does not go from the last pose"));
  EXPECT_THAT(error_of("ODOMETRY 0 0 1 0 0 0 0 0 0 0 0\n"), HasSubstr("does not go from the last pose"));
  EXPECT_THAT(error_of("LANDMARK 7 8 1 1 1 0 1\n"), HasSubstr("refers to an unknown pose or landmark"));
}

TEST(VictoriaParkGraph, RecordingHoldsTheKnownCounts) {
  WAYMARK_REQUIRE_DATA("victoria-park/victoria_park.txt");
  const auto file = test::data_path("victoria-park/victoria_park.txt");
  ASSERT_TRUE(is_victoria_park_graph(file));
  const auto source = open_victoria_park_graph(file);
  ASSERT_TRUE(source.ok()) << source.error().message;
  const auto events = test::read_all(**source).events;
  EXPECT_EQ(only<OdometryPose>(events).size(), 6969U);
  EXPECT_EQ(test::count_observations(events), 3640U);
  EXPECT_EQ(only<Truth>(events).size(), 4285U);
}

}  // namespace
}  // namespace waymark
