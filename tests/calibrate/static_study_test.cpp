#include "workbench/calibrate/static_study.hpp"

#include <cmath>

#include <gmock/gmock.h>

#include "support/io_support.hpp"
#include "waymark/core/angle.hpp"
#include "waymark/core/random.hpp"

#include "workbench/logs/files.hpp"

namespace waymark::calibrate {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::Not;

/// A sensor that errs as sensors do: by scale and offset, by what differs from place to place, and by what
/// differs from observation to observation.
struct Errors {
  double scale = 1.02, offset_m = 0.03, bearing_offset_rad = 0.02;
  double place_m = 0.01, place_rad = 0.005;
  double each_m = 0.004, each_rad = 0.002;
};

PlaceStudy place(RandomStream& random, const Errors& errors, double range_m, double bearing_rad,
                 int count = 50) {
  const double common_m = errors.place_m * random.normal(), common_rad = errors.place_rad * random.normal();
  PlaceStudy study{.place = {"made", range_m, bearing_rad, {}}, .scans = 50, .observations = count};
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  Eigen::Matrix2d squares = Eigen::Matrix2d::Zero();
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector2d error(
        (errors.scale - 1.0) * range_m + errors.offset_m + common_m + errors.each_m * random.normal(),
        errors.bearing_offset_rad + common_rad + errors.each_rad * random.normal());
    sum += error;
    squares += error * error.transpose();
  }
  const Eigen::Vector2d mean = sum / count;
  study.range_error_m = mean[0];
  study.bearing_error_rad = mean[1];
  study.covariance = (squares - count * mean * mean.transpose()) / (count - 1);
  return study;
}

std::vector<PlaceStudy> grid(RandomStream& random, const Errors& errors) {
  std::vector<PlaceStudy> places;
  for (const double range_m : {0.5, 1.0, 1.5, 2.0, 3.0, 4.0})
    for (const double bearing_deg : {-20.0, 0.0, 20.0})
      places.push_back(place(random, errors, range_m, to_radians(bearing_deg)));
  return places;
}

TEST(StaticStudy, FindsBiasAndNoiseWithinWhatItSays) {
  const Errors errors;
  constexpr int kSeeds = 60;
  double scale = 0.0, offset = 0.0, bearing = 0.0, range_m = 0.0, bearing_rad = 0.0;
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    RandomStream random(seed, StreamPurpose::kWorld);
    const auto study = study_of(grid(random, errors));
    ASSERT_TRUE(study.ok());
    ASSERT_TRUE(study->range_scale);
    const auto squared = [](const Value& value, double truth) {
      return std::pow((value.value - truth) / value.sigma, 2) / kSeeds;
    };
    scale += squared(*study->range_scale, errors.scale);
    offset += squared(study->range_offset_m, errors.offset_m);
    bearing += squared(study->bearing_offset_rad, errors.bearing_offset_rad);
    range_m += (study->range->sigma_m.value + 2.0 * study->range->sigma_ratio.value) / kSeeds;
    bearing_rad += study->bearing_sigma_rad.value / kSeeds;
  }
  // Squares of Student's t with 16 or 17 degrees of freedom: mean 1.14, standard deviation 2.0 each. Bounds:
  // four of the mean's.
  for (const double mean : {scale, offset, bearing}) {
    EXPECT_GT(mean, 0.3);
    EXPECT_LT(mean, 2.2);
  }
  EXPECT_NEAR(range_m, std::hypot(errors.place_m, errors.each_m), 0.001);
  EXPECT_NEAR(bearing_rad, std::hypot(errors.place_rad, errors.each_rad), 0.0005);
}

TEST(StaticStudy, OneSidedAnglesAreNotDoubled) {
  RandomStream random(3, StreamPurpose::kWorld);
  const Errors errors;
  auto places = grid(random, errors);
  places.push_back(place(random, errors, 2.0, to_radians(30.0), 3));
  auto study = study_of(places);
  EXPECT_NEAR(to_degrees(study->limits.left_rad.value()), 20.0, 1e-9);
  EXPECT_FALSE(study->limits.right_rad);
  EXPECT_THAT(study->notes, Contains(HasSubstr("its other end was not measured")));
  EXPECT_THAT(to_yaml(*study), Not(HasSubstr("field_of_view")));
  places.push_back(place(random, errors, 2.0, to_radians(-35.0), 40));
  places.push_back(place(random, errors, 2.0, to_radians(-40.0), 3));
  study = study_of(places);
  EXPECT_THAT(to_yaml(*study), HasSubstr("sensor.field_of_view_deg: 55"));
}

TEST(StaticStudy, ALimitNeedsAPlaceBeyondIt) {
  RandomStream random(4, StreamPurpose::kWorld);
  const Errors errors;
  auto places = grid(random, errors);
  auto study = study_of(places);
  EXPECT_FALSE(study->limits.max_range_m || study->limits.min_range_m);
  EXPECT_THAT(study->notes, Contains(HasSubstr("no place ahead of the sensor was too far")));
  places.push_back(place(random, errors, 6.0, 0.0, 10));
  places.push_back(place(random, errors, 0.2, 0.0, 0));
  study = study_of(places);
  EXPECT_DOUBLE_EQ(study->limits.max_range_m.value(), 4.0);
  EXPECT_DOUBLE_EQ(study->limits.min_range_m.value(), 0.5);
}

TEST(StaticStudy, TwoDistancesTellNoScale) {
  RandomStream random(5, StreamPurpose::kWorld);
  const Errors errors;
  const auto study = study_of({place(random, errors, 1.0, 0.0), place(random, errors, 2.0, 0.0)});
  EXPECT_FALSE(study->range_scale);
  EXPECT_THAT(study->notes, Contains(HasSubstr("three or more distances")));
  EXPECT_FALSE(study_of({place(random, errors, 1.0, 0.0), place(random, errors, 2.0, 0.0, 3)}).ok());
}

/// A log folder with a sensor that stands before one or more landmarks.
void write_log(const std::filesystem::path& folder, const std::vector<std::pair<int, double>>& landmarks) {
  std::string rows = "stamp_s,id,range_m,bearing_rad\n";
  for (int i = 0; i < 20; ++i)
    for (const auto& [id, range_m] : landmarks)
      rows += std::to_string(i) + "," + std::to_string(id) + "," +
              std::to_string(range_m + (i % 2 == 0 ? 0.01 : -0.01)) + ",0.1\n";
  std::filesystem::create_directories(folder);
  EXPECT_TRUE(write_file(folder / "log.yaml", "waymark_log: 1\nname: static\n").ok());
  EXPECT_TRUE(write_file(folder / "observations.csv", rows).ok());
}

TEST(StaticStudy, ReadsRecordingsNamedFromTheTable) {
  const test::TempFolder home;
  write_log(home.path() / "a", {{7, 1.1}});
  write_log(home.path() / "b", {{7, 2.1}, {9, 5.0}});
  EXPECT_TRUE(write_file(home.path() / "places.csv",
                         "log,range_m,bearing_deg,id\na,1,5.7295779513,\nb,2,5.7295779513,7\n")
                  .ok());
  const auto places = read_places(home.path() / "places.csv");
  ASSERT_TRUE(places.ok()) << places.error().message;
  const auto study = study_places(*places, {});
  ASSERT_TRUE(study.ok()) << study.error().message;
  EXPECT_EQ(study->places[0].observations, 20);
  EXPECT_NEAR(study->range_offset_m.value, 0.1, 1e-9);
  EXPECT_NEAR(study->bearing_offset_rad.value, 0.0, 1e-9);
  EXPECT_NEAR(std::sqrt(study->places[1].covariance(0, 0)), 0.01 * std::sqrt(20.0 / 19.0), 1e-9);

  EXPECT_TRUE(write_file(home.path() / "two.csv", "log,range_m,bearing_deg\nb,2,0\n").ok());
  const auto unclear = study_places(*read_places(home.path() / "two.csv"), {});
  ASSERT_FALSE(unclear.ok());
  EXPECT_THAT(unclear.error().message, HasSubstr("2 landmarks are observed"));
}

TEST(StaticStudy, RefusesTablesThatMakeNoSense) {
  const test::TempFolder home;
  const auto error_of = [&](const std::string& text) {
    EXPECT_TRUE(write_file(home.path() / "places.csv", text).ok());
    return read_places(home.path() / "places.csv").error().message;
  };
  EXPECT_THAT(error_of("log,range_m,bearing_deg\na,-1,0\n"), HasSubstr("places.csv:2"));
  EXPECT_THAT(error_of("log,range_m,bearing_deg\na,near,0\n"), HasSubstr("places.csv:2"));
  EXPECT_THAT(error_of("log,range_m,bearing_deg\n"), HasSubstr("the table has no rows"));
  EXPECT_THAT(error_of("log,range_m\na,1\n"), HasSubstr("bearing_deg"));
}

}  // namespace
}  // namespace waymark::calibrate
