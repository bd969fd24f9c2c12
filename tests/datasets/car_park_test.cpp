#include "workbench/datasets/car_park.hpp"

#include <gmock/gmock.h>

#include "support/data_dir.hpp"
#include "support/io_support.hpp"

#include "datasets/mat_support.hpp"

namespace waymark {
namespace {

using test::only;
using test::TempFolder;
using testing::HasSubstr;

/// One scan with a reflector straight ahead.
std::string log_bytes(Eigen::Index beams = 361, Eigen::Index scans = 1) {
  Eigen::MatrixXd ranges = Eigen::MatrixXd::Constant(scans, beams, 81.9);
  Eigen::MatrixXd intensities = Eigen::MatrixXd::Zero(scans, beams);
  ranges(0, 180) = 7.0;
  intensities(0, 180) = 8192.0;
  const Eigen::MatrixXd pair{{1.0, 2.0}};
  return test::mat_header() + test::mat_variable("Time_VS", pair) + test::mat_variable("Velocity", pair) +
         test::mat_variable("Steering", 0.1 * pair) +
         test::mat_variable("TimeLaser", Eigen::MatrixXd{{1.5}}) + test::mat_variable("Laser", ranges) +
         test::mat_variable("Intensity", intensities) + test::mat_variable("TimeGPS", pair) +
         test::mat_variable("GPSLon", pair) + test::mat_variable("GPSLat", -pair);
}

Result<std::unique_ptr<Source>> open_car_park(const TempFolder& folder, const std::string& bytes) {
  const auto file = MatFile::open(folder.write("data_set.mat", bytes));
  EXPECT_TRUE(file.ok()) << file.error().message;
  EXPECT_TRUE(is_car_park(*file));
  return open_car_park(*file);
}

TEST(CarPark, ReadsSteeringReflectorsAndTruth) {
  const TempFolder folder;
  folder.write("beac_juan3.mat",
               test::mat_header() + test::mat_variable("estbeac", Eigen::MatrixXd{{1.0, 2.0}, {3.0, 4.0}}));
  const auto source = open_car_park(folder, log_bytes()).value();
  const auto events = test::read_all(*source).events;
  EXPECT_EQ(only<Steering>(events)[1].second.steer_rad, 0.2);
  const auto scans = only<Observations>(events);
  ASSERT_EQ(scans.size(), 1U);
  ASSERT_EQ(scans[0].second.size(), 1U);
  EXPECT_EQ(std::get<RangeBearing>(scans[0].second[0].value).range_m, 7.0);
  EXPECT_NEAR(std::get<RangeBearing>(scans[0].second[0].value).bearing_rad, 0.0, 1e-12);
  ASSERT_EQ(only<Truth>(events).size(), 2U);
  EXPECT_EQ(only<Truth>(events)[1].second.y_m, -2.0);
  EXPECT_EQ(source->info().truth_sensor_m, Eigen::Vector2d(3.78, 0.5));
  ASSERT_EQ(source->info().landmarks.size(), 2U);
  EXPECT_EQ(source->info().landmarks[1].x_m, 3.0);
}

TEST(CarPark, WrongShapesAreNamed) {
  const TempFolder folder;
  EXPECT_THAT(open_car_park(folder, log_bytes(360)).error().message,
              HasSubstr("variable Laser has 360 columns; expected 361"));
  EXPECT_THAT(open_car_park(folder, log_bytes(361, 2)).error().message,
              HasSubstr("variable Laser has 2 values for 1 times"));
  folder.write("beac_juan3.mat", test::mat_header() + test::mat_variable("estbeac", Eigen::MatrixXd{{1.0}}));
  EXPECT_THAT(open_car_park(folder, log_bytes()).error().message,
              HasSubstr("beac_juan3.mat: variable estbeac has 1 columns; expected 2"));
}

TEST(CarPark, RecordingHoldsTheKnownCounts) {
  WAYMARK_REQUIRE_DATA("car-park");
  const auto file = MatFile::open(test::data_path("car-park") / kCarParkLog);
  ASSERT_TRUE(file.ok()) << file.error().message;
  const auto source = open_car_park(*file).value();
  const auto events = test::read_all(*source).events;
  EXPECT_EQ(only<Steering>(events).size(), 5001U);
  EXPECT_EQ(only<Truth>(events).size(), 626U);
  EXPECT_EQ(only<Observations>(events).size(), 586U);
  EXPECT_EQ(test::count_observations(events), 910U);
  EXPECT_EQ(source->info().landmarks.size(), 15U);
}

}  // namespace
}  // namespace waymark
