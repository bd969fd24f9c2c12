#include "workbench/datasets/victoria_park.hpp"

#include <gmock/gmock.h>

#include "support/data_dir.hpp"
#include "support/io_support.hpp"
#include "waymark/core/angle.hpp"

#include "datasets/mat_support.hpp"

namespace waymark {
namespace {

using test::only;
using test::TempFolder;
using testing::ElementsAre;
using testing::HasSubstr;

/// Two scans, the second without trees, and two readings of the wheels.
std::string log_bytes(const std::vector<Eigen::MatrixXd>& scans, const Eigen::MatrixXd& u) {
  return test::mat_header() + test::mat_variable("time", Eigen::MatrixXd{{1.0, 1.025}}) +
         test::mat_variable("TLsr", Eigen::MatrixXd{{1.01, 1.22}}) + test::mat_cells("zt", scans) +
         test::mat_variable("u", u);
}

const Eigen::MatrixXd kTree{{12.5}, {kPi}, {0.3}};
const Eigen::MatrixXd kNone = Eigen::MatrixXd::Zero(3, 0);
const Eigen::MatrixXd kU{{2.0, 3.0}, {0.1, -0.2}};

Result<std::unique_ptr<Source>> open_victoria_park(const TempFolder& folder, const std::string& bytes) {
  const auto file = MatFile::open(folder.write(kVictoriaParkLog, bytes));
  if (!file) return file.error();
  EXPECT_TRUE(is_victoria_park(*file));
  return open_victoria_park(*file);
}

std::string fixes_bytes() {
  Eigen::MatrixXd times(1, 4), places(1, 4);
  times << 1000.0, 1200.0, 1400.0, 1600.0;
  places << 0.0, 1.0, 2.0, 99.0;
  return test::mat_header() + test::mat_variable("timeGps", times) + test::mat_variable("Lo_m", places) +
         test::mat_variable("La_m", -places);
}

TEST(VictoriaPark, ReadsSteeringAndTreesWithBearingsFromAhead) {
  const TempFolder folder;
  const auto source = open_victoria_park(folder, log_bytes({kTree, kNone}, kU)).value();
  const auto events = test::read_all(*source).events;
  const auto steering = only<Steering>(events);
  ASSERT_EQ(steering.size(), 2U);
  EXPECT_EQ(steering[1].first, stamp_from_seconds(1.025));
  EXPECT_EQ(steering[1].second.v_mps, 3.0);
  EXPECT_EQ(steering[1].second.steer_rad, -0.2);
  const auto scans = only<Observations>(events);
  ASSERT_EQ(scans.size(), 2U);
  ASSERT_EQ(scans[0].second.size(), 1U);
  EXPECT_FALSE(scans[0].second[0].id.has_value());
  EXPECT_EQ(std::get<RangeBearing>(scans[0].second[0].value).range_m, 12.5);
  EXPECT_NEAR(std::get<RangeBearing>(scans[0].second[0].value).bearing_rad, kPi / 2.0, 1e-12);
  EXPECT_TRUE(scans[1].second.empty());
  EXPECT_FALSE(source->info().identities);
  EXPECT_THAT(source->notes(), ElementsAre(HasSubstr("no ground truth")));
}

TEST(VictoriaPark, TruthIsOfTheAntennaAndWithoutHeading) {
  const TempFolder folder;
  folder.write("aa3_gpsx.mat", fixes_bytes());
  const auto source = open_victoria_park(folder, log_bytes({kTree, kNone}, kU)).value();
  const auto truth = only<Truth>(test::read_all(*source).events);
  ASSERT_EQ(truth.size(), 1U);
  EXPECT_EQ(truth[0].first, stamp_from_seconds(1.2));
  EXPECT_EQ(truth[0].second.x_m, 1.0);
  EXPECT_EQ(truth[0].second.y_m, -1.0);
  EXPECT_FALSE(truth[0].second.theta_rad.has_value());
  EXPECT_EQ(source->info().truth_sensor_m, Eigen::Vector2d(3.78, 0.5));
  EXPECT_THAT(source->notes(), ElementsAre(HasSubstr("3 of 4 GPS positions left out")));
}

TEST(VictoriaPark, WrongShapesAndDamageAreNamed) {
  const TempFolder folder;
  const auto error_of = [&folder](const std::string& bytes) {
    return open_victoria_park(folder, bytes).error().message;
  };
  EXPECT_THAT(error_of(log_bytes({kTree}, kU)), HasSubstr("variable zt has 1 values for 2 times"));
  EXPECT_THAT(error_of(log_bytes({kTree, Eigen::MatrixXd::Zero(2, 1)}, kU)),
              HasSubstr("variable zt: cell 2 has 2 rows; expected 3 (range m, bearing rad, diameter m)"));
  EXPECT_THAT(error_of(log_bytes({kTree, kNone}, Eigen::MatrixXd::Zero(3, 2))),
              HasSubstr("variable u has 3 rows; expected 2 (speed m/s, steering rad)"));
  EXPECT_THAT(error_of(log_bytes({kTree, kNone}, kU).substr(0, 400)), HasSubstr("damaged MATLAB file"));
  folder.write("aa3_gpsx.mat", fixes_bytes().substr(0, 200));
  EXPECT_THAT(error_of(log_bytes({kTree, kNone}, kU)), HasSubstr("aa3_gpsx.mat: damaged MATLAB file"));
}

TEST(VictoriaPark, RecordingHoldsTheKnownCounts) {
  WAYMARK_REQUIRE_DATA("victoria-park");
  const auto file = MatFile::open(test::data_path("victoria-park") / kVictoriaParkLog);
  ASSERT_TRUE(file.ok()) << file.error().message;
  const auto source = open_victoria_park(*file).value();
  const auto events = test::read_all(*source).events;
  EXPECT_EQ(only<Steering>(events).size(), 61945U);
  EXPECT_EQ(only<Observations>(events).size(), 7249U);
  EXPECT_EQ(test::count_observations(events), 52974U);
  EXPECT_EQ(only<Truth>(events).size(), 4285U);
  EXPECT_NEAR(to_seconds(events.back().stamp - events.front().stamp), 1549.5, 1.0);
}

}  // namespace
}  // namespace waymark
