#include "workbench/datasets/lost_in_the_woods.hpp"

#include <gmock/gmock.h>

#include "support/data_dir.hpp"
#include "support/io_support.hpp"

#include "datasets/mat_support.hpp"

namespace waymark {
namespace {

using test::only;
using test::TempFolder;
using testing::Contains;
using testing::HasSubstr;

/// Two rows: the first sees tube 3, the second nothing and has no truth.
std::string woods(const Eigen::MatrixXd& times = Eigen::MatrixXd{{0.0}, {0.1}}) {
  Eigen::MatrixXd r = Eigen::MatrixXd::Zero(2, 17);
  Eigen::MatrixXd b = r;
  r(0, 2) = 1.5;
  b(0, 2) = -0.25;
  const auto column = [](double first, double second) { return Eigen::MatrixXd{{first}, {second}}; };
  return test::mat_header() + test::mat_variable("t", times) + test::mat_variable("v", column(0.5, 0.6)) +
         test::mat_variable("om", column(0.1, 0.2)) + test::mat_variable("r", r) +
         test::mat_variable("b", b) + test::mat_variable("x_true", column(1.0, 9.0)) +
         test::mat_variable("y_true", column(2.0, 9.0)) + test::mat_variable("th_true", column(3.0, 9.0)) +
         test::mat_variable("true_valid", column(1.0, 0.0)) +
         test::mat_variable("l", Eigen::MatrixXd{{1.0, 2.0}, {3.0, 4.0}}) +
         test::mat_variable("d", Eigen::MatrixXd{{0.219}});
}

Result<std::unique_ptr<Source>> open_woods(const TempFolder& folder, const std::string& bytes) {
  const auto file = MatFile::open(folder.write("dataset2.mat", bytes));
  EXPECT_TRUE(file.ok()) << file.error().message;
  EXPECT_TRUE(is_lost_in_the_woods(*file));
  return open_lost_in_the_woods(*file);
}

TEST(LostInTheWoods, ZeroIsNotSeenAndInvalidTruthIsNone) {
  const TempFolder folder;
  const auto source = open_woods(folder, woods()).value();
  const auto events = test::read_all(*source).events;
  const auto seen = only<Observations>(events);
  ASSERT_EQ(seen.size(), 1U);
  ASSERT_EQ(seen[0].second.size(), 1U);
  EXPECT_EQ(seen[0].second[0].id, (LandmarkId{LandmarkId::Family::kMarker, 3}));
  EXPECT_EQ(std::get<RangeBearing>(seen[0].second[0].value).bearing_rad, -0.25);
  EXPECT_EQ(only<Velocity>(events).size(), 2U);
  ASSERT_EQ(only<Truth>(events).size(), 1U);
  EXPECT_EQ(only<Truth>(events)[0].second.theta_rad, 3.0);
}

TEST(LostInTheWoods, PlaceOfTheLaserComesFromTheFile) {
  const TempFolder folder;
  const auto source = open_woods(folder, woods()).value();
  using Setting = std::pair<std::string, std::string>;
  EXPECT_THAT(source->info().settings, Contains(Setting("sensor.x_m", "0.219")));
  ASSERT_EQ(source->info().landmarks.size(), 2U);
  EXPECT_EQ(source->info().landmarks[1].id.number, 2);
  EXPECT_EQ(source->info().landmarks[1].y_m, 4.0);
}

TEST(LostInTheWoods, ColumnsOfUnequalLengthAndTimeThatGoesBackAreNamed) {
  const TempFolder folder;
  EXPECT_THAT(open_woods(folder, woods(Eigen::MatrixXd{{0.0}, {0.1}, {0.2}})).error().message,
              HasSubstr("dataset2.mat: variable v has 2 rows, t has 3"));
  EXPECT_THAT(open_woods(folder, woods(Eigen::MatrixXd{{0.0}, {-0.1}})).error().message,
              HasSubstr("variable t: row 2 goes back in time"));
}

TEST(LostInTheWoods, RecordingHoldsTheKnownCounts) {
  WAYMARK_REQUIRE_DATA("lost-in-the-woods/dataset2.mat");
  const auto file = MatFile::open(test::data_path("lost-in-the-woods/dataset2.mat"));
  ASSERT_TRUE(file.ok()) << file.error().message;
  const auto source = open_lost_in_the_woods(*file).value();
  const auto events = test::read_all(*source).events;
  EXPECT_EQ(only<Velocity>(events).size(), 12609U);
  EXPECT_EQ(only<Truth>(events).size(), 12609U - 331U);
  EXPECT_EQ(only<Observations>(events).size(), 12609U - 76U);
  EXPECT_EQ(test::count_observations(events), 61086U);
  EXPECT_EQ(source->info().landmarks.size(), 17U);
}

}  // namespace
}  // namespace waymark
