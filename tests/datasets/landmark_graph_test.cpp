#include "workbench/datasets/landmark_graph.hpp"

#include <cmath>
#include <string>

#include <gmock/gmock.h>

#include "support/io_support.hpp"
#include "waymark/core/angle.hpp"

namespace waymark {
namespace {

using test::only;
using test::TempFolder;
using testing::Contains;
using testing::HasSubstr;

constexpr const char* kG2o =
    "# a robot that drives ahead, turns left and drives on\n"
    "VERTEX_SE2 0 9 9 9\n"
    "VERTEX_XY 1 99 99\n"
    "VERTEX_SE2 2 9 9 9\n"
    "VERTEX_SE2 7 9 9 9\n"
    "FIX 0\n"
    "EDGE_SE2 0 2 1 0 1.5707963267948966 400 0 0 100 0 2500\n"
    "EDGE_SE2 2 7 1 0 0 400 0 0 100 0 2500\n"
    "EDGE_SE2 0 7 5 5 5 400 0 0 100 0 2500\n"
    "EDGE_SE2_XY 0 1 3 4 25 0 100\n"
    "EDGE_BEARING_SE2_XY 2 5 0.5 100\n"
    "EDGE_RANGE 7 5 2.5 4\n";

Result<std::unique_ptr<Source>> open(const std::string& text, const std::string& name = "graph.g2o") {
  const TempFolder folder;
  const auto file = folder.write(name, text);
  EXPECT_TRUE(is_landmark_graph(file));
  return open_landmark_graph(file);
}

std::string error_of(const std::string& text) {
  const auto source = open(text);
  return source ? "none" : source.error().message;
}

std::string setting(const LogInfo& info, const std::string& key) {
  for (const auto& [name, value] : info.settings)
    if (name == key) return value;
  return "none";
}

TEST(LandmarkGraph, ReadsOdometryAndObservationsOfG2o) {
  const auto source = open(kG2o).value();
  const auto events = test::read_all(*source).events;
  const auto poses = only<OdometryPose>(events);
  ASSERT_EQ(poses.size(), 3U);
  EXPECT_LT(difference(poses[2].second.T_odom_robot, Pose2{1.0, 1.0, kPi / 2}).norm(), 1e-12);
  EXPECT_EQ(poses[2].first, stamp_from_seconds(2.0));
  const auto seen = only<Observations>(events);
  ASSERT_EQ(seen.size(), 3U);
  EXPECT_EQ(seen[0].first, poses[0].first);
  EXPECT_EQ(seen[0].second[0].id, (LandmarkId{LandmarkId::Family::kMarker, 1}));
  const auto z = std::get<RangeBearing>(seen[0].second[0].value);
  EXPECT_NEAR(z.range_m, 5.0, 1e-12);
  EXPECT_NEAR(z.bearing_rad, std::atan2(4.0, 3.0), 1e-12);
  EXPECT_EQ(std::get<Bearing>(seen[1].second[0].value).bearing_rad, 0.5);
  EXPECT_NEAR((*seen[1].second[0].covariance)(0, 0), 0.01, 1e-12);
  EXPECT_EQ(std::get<Range>(seen[2].second[0].value).range_m, 2.5);
  EXPECT_NEAR((*seen[2].second[0].covariance)(0, 0), 0.25, 1e-12);
  EXPECT_TRUE(source->info().identities);
}

TEST(LandmarkGraph, TheNoiseIsThatOfTheInformation) {
  const auto source = open(kG2o).value();
  const auto events = test::read_all(*source).events;
  const Eigen::Matrix2d P = *only<Observations>(events)[0].second[0].covariance;
  // Of (3, 4) with variances 0.04 and 0.01: along (0.6, 0.8), across (-0.8, 0.6), at 5 m.
  EXPECT_NEAR(P(0, 0), 0.36 * 0.04 + 0.64 * 0.01, 1e-12);
  EXPECT_NEAR(P(1, 1), (0.64 * 0.04 + 0.36 * 0.01) / 25.0, 1e-12);
  EXPECT_NEAR(P(0, 1), 0.48 * (0.01 - 0.04) / 5.0, 1e-12);
  EXPECT_EQ(setting(source->info(), "motion.forward_var_m2_per_m"), "0.0025");
  EXPECT_EQ(setting(source->info(), "motion.lateral_var_m2_per_m"), "0.01");
  EXPECT_EQ(setting(source->info(), "motion.turn_var_rad2_per_m"), "0.0004");
}

TEST(LandmarkGraph, VerticesOfG2oAreNoTruthAndWhatIsNotUsedIsSaid) {
  const auto source = open(kG2o).value();
  EXPECT_TRUE(only<Truth>(test::read_all(*source).events).empty());
  EXPECT_TRUE(source->info().landmarks.empty());
  EXPECT_THAT(source->notes(), testing::ElementsAre(HasSubstr("no ground truth"), HasSubstr("1 s apart"),
                                                    HasSubstr("1 edges between poses that do not follow"),
                                                    HasSubstr("1 lines FIX are not used")));
}

TEST(LandmarkGraph, AFrameThatMovesSidewaysIsTurned) {
  const auto source = open(
                          "EDGE_SE2 0 1 0 -1 0 400 0 0 100 0 2500\n"
                          "EDGE_SE2_XY 1 2 0 -3 25 0 100\n")
                          .value();
  const auto events = test::read_all(*source).events;
  EXPECT_LT(difference(only<OdometryPose>(events)[1].second.T_odom_robot, Pose2{1.0, 0.0, 0.0}).norm(),
            1e-12);
  const Observation seen = only<Observations>(events)[0].second[0];
  EXPECT_NEAR(std::get<RangeBearing>(seen.value).range_m, 3.0, 1e-12);
  EXPECT_NEAR(std::get<RangeBearing>(seen.value).bearing_rad, 0.0, 1e-12);
  EXPECT_NEAR((*seen.covariance)(0, 0), 0.01, 1e-12);
  EXPECT_EQ(setting(source->info(), "motion.forward_var_m2_per_m"), "0.01");
  EXPECT_THAT(source->notes(), Contains(HasSubstr("-y axis")));
}

TEST(LandmarkGraph, ReadsPyFactorGraphWithItsStampsAndItsTruth) {
  const auto source = open(
                          "VERTEX_SE2 10.5 A0 1 2 0.1\n"
                          "VERTEX_SE2 10.7 A1 2 2 0.1\n"
                          "VERTEX_SE2 10.5 B0 5 5 0\n"
                          "VERTEX_XY L3 7 8\n"
                          "VERTEX_SE2:PRIOR 10.5 A0 1 2 0.1 1 0 0 1 0 1\n"
                          "EDGE_SE2 10.7 A0 A1 1 0 0 0.01 0 0 0.01 0 0.04\n"
                          "EDGE_RANGE 10.7 A1 L3 4.5 0.25\n"
                          "EDGE_RANGE 10.7 A1 B0 4.5 0.25\n",
                          "plaza.pyfg")
                          .value();
  const auto events = test::read_all(*source).events;
  const auto truth = only<Truth>(events);
  ASSERT_EQ(truth.size(), 2U);
  EXPECT_EQ(truth[0].first, stamp_from_seconds(10.5));
  EXPECT_EQ(truth[1].second.x_m, 2.0);
  const auto seen = only<Observations>(events);
  ASSERT_EQ(seen.size(), 1U);
  ASSERT_EQ(seen[0].second.size(), 1U) << "a range to another robot";
  EXPECT_EQ(std::get<Range>(seen[0].second[0].value).range_m, 4.5);
  EXPECT_NEAR((*seen[0].second[0].covariance)(0, 0), 0.25, 1e-12) << "a variance";
  ASSERT_EQ(source->info().landmarks.size(), 1U);
  EXPECT_EQ(source->info().landmarks[0].id, seen[0].second[0].id);
  EXPECT_EQ(setting(source->info(), "motion.turn_var_rad2_per_m"), "0.04");
  EXPECT_THAT(source->notes(), Contains(HasSubstr("taken as ground truth")));
  EXPECT_THAT(source->notes(), Contains(HasSubstr("1 poses of other robots than A")));
}

TEST(LandmarkGraph, ReadsNumbersThatHoldALetter) {
  const std::string x = std::to_string((std::uint64_t{'x'} << 56) + 4),
                    next = std::to_string((std::uint64_t{'x'} << 56) + 5),
                    l = std::to_string((std::uint64_t{'l'} << 56) + 4);
  const auto source = open("EDGE_SE2 " + x + " " + next + " 1 0 0 400 0 0 100 0 2500\nEDGE_SE2_XY " + x +
                           " " + l + " 3 4 25 0 100\n")
                          .value();
  EXPECT_EQ(only<Observations>(test::read_all(*source).events)[0].second[0].id->number, 4);
}

TEST(LandmarkGraph, PosesInSpaceAreReadWhereTheyStayInThePlane) {
  const std::string noise = " 100 0 0 0 0 0 100 0 0 0 0 100 0 0 0 100 0 0 100 0 2500\n";
  const std::string seen = "EDGE_SE3_XYZ 1 2 3 4 1 25 0 0 100 0 100\n";
  const auto source = open("EDGE_SE3:QUAT 0 1 1 0 0 0 0 1 1" + noise + seen).value();
  const auto events = test::read_all(*source).events;
  EXPECT_NEAR(only<OdometryPose>(events)[1].second.T_odom_robot.theta_rad, kPi / 2, 1e-12);
  EXPECT_NEAR(std::get<RangeBearing>(only<Observations>(events)[0].second[0].value).range_m, 5.0, 1e-12);
  EXPECT_EQ(setting(source->info(), "motion.turn_var_rad2_per_m"), "0.0004");
  EXPECT_THAT(error_of("EDGE_SE3:QUAT 0 1 1 0 0.5 0 0 0 1" + noise + seen), HasSubstr("leave the plane"));
  EXPECT_THAT(error_of("EDGE_SE3:QUAT 0 1 1 0 0 0.3 0 0 1" + noise + seen), HasSubstr("leave the plane"));
}

TEST(LandmarkGraph, RefusesWhatIsNoLogAndNamesBadLines) {
  EXPECT_THAT(error_of("VERTEX_SE2 0 0 0 0\nEDGE_SE2 0 1 1 0 0 1 0 0 1 0 1\n"),
              HasSubstr("pose graph without observations of landmarks"));
  EXPECT_THAT(error_of("VERTEX_SE2 0 0 0 0\nVERTEX_SE2 1 0 0 0\nEDGE_SE2_XY 0 5 3 4 25 0 100\n"),
              HasSubstr("no edge leads from pose 0 to 1"));
  EXPECT_THAT(error_of("EDGE_SE2 0 1 1 0\n"), HasSubstr("graph.g2o:1: expected 2 vertices and 9 numbers"));
  EXPECT_THAT(error_of("EDGE_SE2_XY 0 1 x 4 25 0 100\n"),
              HasSubstr("graph.g2o:1: 'x' is not a finite number"));
  EXPECT_THAT(error_of("EDGE_SE2_XY 0 -1 3 4 25 0 100\n"), HasSubstr("'-1' is not the name of a vertex"));
  const TempFolder folder;
  EXPECT_FALSE(is_landmark_graph(folder.write("a.txt", "ODOMETRY 0 1 1 0 0\n")));
  EXPECT_FALSE(is_landmark_graph(folder.write("b.txt", "1 2 3 0 0 0 0 1\n")));
}

}  // namespace
}  // namespace waymark
