#include "workbench/logs/pose_covariances.hpp"

#include <gmock/gmock.h>

#include "support/io_support.hpp"

namespace waymark {
namespace {

using test::TempFolder;
using testing::HasSubstr;

Trajectory poses(std::initializer_list<double> stamps_s) {
  Trajectory trajectory;
  for (const double s : stamps_s) trajectory.push_back({stamp_from_seconds(s), {}, std::nullopt});
  return trajectory;
}

Eigen::Matrix3d covariance(double scale) {
  return scale / 3.0 * Eigen::Matrix3d{{2.0, 0.1, 0.2}, {0.1, 3.0, 0.3}, {0.2, 0.3, 4.0}};
}

TEST(PoseCovariances, ReadBackToTheLastBitAndLeaveGaps) {
  const TempFolder folder;
  Trajectory written = poses({1.0, 1.0, 2.0, 3.0});
  written[0].covariance = covariance(1.0);
  written[1].covariance = covariance(1e-9);
  written[3].covariance = covariance(7.0);
  ASSERT_TRUE(write_pose_covariances(folder.path() / "c.csv", written).ok());
  Trajectory read = poses({1.0, 1.0, 2.0, 3.0});
  const auto done = read_pose_covariances(folder.path() / "c.csv", read);
  ASSERT_TRUE(done.ok()) << done.error().message;
  for (std::size_t i = 0; i < read.size(); ++i) EXPECT_EQ(read[i].covariance, written[i].covariance) << i;
}

TEST(PoseCovariances, FileOfAnotherRunIsNamed) {
  const TempFolder folder;
  Trajectory trajectory = poses({1.0, 2.0});
  const auto file =
      folder.write("c.csv", "stamp_s,sxx,sxy,sxt,syy,syt,stt\n1,1,0,0,1,0,1\n1.5,1,0,0,1,0,1\n");
  EXPECT_THAT(read_pose_covariances(file, trajectory).error().message,
              HasSubstr("c.csv:3: no pose of the trajectory has this stamp"));
  folder.write("c.csv", "stamp_s,sxx,sxy,sxt,syy,syt,stt\n1,1,2,0,1,0,1\n");
  EXPECT_THAT(read_pose_covariances(file, trajectory).error().message,
              HasSubstr("not positive semi-definite"));
}

}  // namespace
}  // namespace waymark
