#include "workbench/logs/trajectory_file.hpp"

#include <cmath>
#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "support/io_support.hpp"
#include "waymark/core/angle.hpp"

namespace waymark {
namespace {

using test::TempFolder;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

TrajectoryFile read(const std::string& text) {
  const TempFolder folder;
  auto file = read_trajectory(folder.write("path.txt", text));
  EXPECT_TRUE(file.ok()) << file.error().message;
  return file ? *std::move(file) : TrajectoryFile{};
}

std::string error_of(const std::string& text) {
  const TempFolder folder;
  const auto file = read_trajectory(folder.write("path.txt", text));
  return file ? "none" : file.error().message;
}

double heading_rad(const SpacePose& pose) { return 2.0 * std::atan2(pose.q.z(), pose.q.w()); }

TEST(TrajectoryFile, ReadsTumBetweenAnySeparators) {
  for (const char* text :
       {"1.5 2 3 4 0 0 0.6 0.8\n", "# t x y\n1.5\t2\t3\t4\t0\t0\t0.6\t0.8\r\n", "1.5,2,3,4,0,0,0.6,0.8\n",
        "1.5, 2, 3, 4, 0, 0, 0.6, 0.8,\n", "1.5;2;3;4;0;0;0.6;0.8",
        "timestamp tx ty tz qx qy qz qw\n1.5e0 2 3 4 0 0 1.2 1.6\n",
        "timestamp,tx,ty,tz,qx,qy,qz,qw\n1.5,2,3,4,0,0,0.6,0.8\n"}) {
    const TrajectoryFile file = read(text);
    EXPECT_EQ(file.format, "TUM");
    EXPECT_THAT(file.notes, IsEmpty()) << text;
    ASSERT_EQ(file.path.size(), 1U) << text;
    EXPECT_EQ(file.path[0].stamp, stamp_from_seconds(1.5));
    EXPECT_EQ(file.path[0].p_m, Eigen::Vector3d(2, 3, 4));
    EXPECT_NEAR(heading_rad(file.path[0]), 2.0 * std::atan2(0.6, 0.8), 1e-12);
  }
}

TEST(TrajectoryFile, FurtherColumnsAreLeftOutAndNamed) {
  const TrajectoryFile file = read("1 2 3 4 0 0 0 1 0.01 0 0 0.01 0 0.01\n");
  EXPECT_EQ(file.path[0].p_m, Eigen::Vector3d(2, 3, 4));
  EXPECT_THAT(file.notes, ElementsAre(HasSubstr("path.txt: rows have 14 columns: the first 8 are used")));
  EXPECT_EQ(read("1 2 3 4 0 0 0 1 9 9 9 9\n").format, "TUM") << "12 columns that are no matrix";
}

TEST(TrajectoryFile, ReadsEurocByTheNamesInItsHeader) {
  const TrajectoryFile file = read(
      "#timestamp, p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], q_RS_w [], q_RS_x [], q_RS_y [], q_RS_z [], "
      "v_RS_R_x [m s^-1]\n"
      "1700000000050000001,2,3,4,0.8,0,0,0.6,9\n");
  EXPECT_EQ(file.format, "EuRoC");
  EXPECT_EQ(file.path[0].stamp, Stamp{Duration{1700000000050000001}});
  EXPECT_NEAR(heading_rad(file.path[0]), 2.0 * std::atan2(0.6, 0.8), 1e-12);
  EXPECT_THAT(file.notes,
              ElementsAre(HasSubstr("nanoseconds"), HasSubstr("w, x, y, z"), HasSubstr("9 columns")));
}

TEST(TrajectoryFile, FindsTheNamesBelowOtherComments) {
  EXPECT_EQ(read("# path of robot 1\n# stamp x y z qw qx qy qz\n1.5 2 3 4 1 0 0 0\n").format, "EuRoC");
  EXPECT_EQ(read("# quick test\nt x y z qx qy qz qw\n1.5 2 3 4 1 0 0 0\n").format, "TUM");
}

TEST(TrajectoryFile, TakesCommasWithNanosecondsAsEurocAndBlanksAsTum) {
  EXPECT_EQ(read("1700000000050000001,2,3,4,0.8,0,0,0.6\n").format, "EuRoC");
  const TrajectoryFile blanks = read("1700000000050000001 2 3 4 0 0 0.6 0.8\n");
  EXPECT_EQ(blanks.format, "TUM");
  EXPECT_EQ(blanks.path[0].stamp, Stamp{Duration{1700000000050000001}});
  EXPECT_THAT(blanks.notes, ElementsAre("path.txt: stamps are taken as nanoseconds"));
  EXPECT_EQ(read("# timestamp tx ty tz qx qy qz qw\n1700000000050000001,2,3,4,0,0,0.6,0.8\n").format, "TUM");
}

TEST(TrajectoryFile, ReadsKittiWithoutStamps) {
  const TrajectoryFile file = read("1 0 0 2 0 1 0 3 0 0 1 4\n0 -1 0 5 1 0 0 6 0 0 1 7\n");
  EXPECT_EQ(file.format, "KITTI");
  EXPECT_FALSE(file.has_stamps);
  ASSERT_EQ(file.path.size(), 2U);
  EXPECT_EQ(file.path[0].p_m, Eigen::Vector3d(2, 3, 4));
  EXPECT_NEAR(heading_rad(file.path[1]), kPi / 2, 1e-12);
  EXPECT_LT(file.path[0].stamp, file.path[1].stamp);
  EXPECT_THAT(file.notes, ElementsAre(HasSubstr("without stamps")));
}

TEST(TrajectoryFile, RepeatedStampsAreCounted) {
  EXPECT_THAT(
      read("1 0 0 0 0 0 0 1\n1 1 0 0 0 0 0 1\n1 2 0 0 0 0 0 1\n2 3 0 0 0 0 0 1\n").notes,
      ElementsAre(HasSubstr("2 of 4 rows have the same stamp as the row before: stamps are whole seconds")));
  EXPECT_THAT(read("1.5 0 0 0 0 0 0 1\n1.5 1 0 0 0 0 0 1\n").notes,
              ElementsAre(HasSubstr("1 of 2 rows have the same stamp as the row before")));
}

TEST(TrajectoryFile, BadRowsAreErrorsWithTheirLine) {
  EXPECT_THAT(error_of("1 2 3 0 0 0 0 1\n2 2 3 0 0 0"), HasSubstr("path.txt:2: expected 8 columns"));
  EXPECT_THAT(error_of("1 2 3\n"), HasSubstr("path.txt:1: expected 8 columns or more (stamp_s tx ty"));
  EXPECT_THAT(error_of("1 2 3 0 0 0 0 0\n"), HasSubstr("path.txt:1: the quaternion is zero"));
  EXPECT_THAT(error_of("1 nan 3 0 0 0 0 1\n"), HasSubstr("path.txt:1: 'nan'"));
  EXPECT_THAT(error_of("1,2,,0,0,0,0,1\n"), HasSubstr("path.txt:1: '' is not a finite number"));
  EXPECT_THAT(error_of("1,2 3,0,0,0,0,1,2\n"), HasSubstr("path.txt:1: '2 3' is not"));
  EXPECT_THAT(error_of("t x\nt x\n"), HasSubstr("path.txt:2: 't'"));
  EXPECT_THAT(error_of("2 0 0 0 0 0 0 1\n1 0 0 0 0 0 0 1\n"),
              HasSubstr("path.txt:2: stamp 1.000000000 is before"));
  EXPECT_THAT(error_of("1 0 0 2 0 1 0 3 0 0 1 4\n9 0 0 2 0 1 0 3 0 0 1 4\n"),
              HasSubstr("path.txt:2: the matrix is no rotation"));
  EXPECT_THAT(error_of("# only words\n"), HasSubstr("path.txt: has no rows; expected"));
  EXPECT_THAT(read_trajectory("nowhere.txt").error().message, HasSubstr("nowhere.txt"));
}

}  // namespace
}  // namespace waymark
