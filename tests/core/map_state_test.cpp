#include "waymark/core/map_state.hpp"

#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace waymark {
namespace {

using testing::HasSubstr;

MapState two_landmarks() {
  MapState map;
  map.ids = {{LandmarkId::Family::kMarker, 1}, {LandmarkId::Family::kMarker, 2}};
  map.observations = {3, 4};
  map.landmarks = Eigen::VectorXd::Zero(4);
  map.covariance = Eigen::MatrixXd::Identity(7, 7);
  return map;
}

TEST(MapState, FitsAFilterOfItsDimensionWithRoom) {
  EXPECT_TRUE(check_fits(two_landmarks(), 2, 2));
  EXPECT_TRUE(check_fits(two_landmarks(), 2, 100));
}

TEST(MapState, SaysWhyItDoesNotFit) {
  const auto why = [](const MapState& map, int dimension, int capacity) {
    const auto fits = check_fits(map, dimension, capacity);
    return fits ? std::string("it fits") : fits.error().message;
  };
  EXPECT_THAT(why(two_landmarks(), 3, 100), HasSubstr("dimension 2, not 3"));
  EXPECT_THAT(why(two_landmarks(), 2, 1), HasSubstr("capacity of the filter, 1"));
  MapState map = two_landmarks();
  map.covariance.conservativeResize(7, 6);
  EXPECT_THAT(why(map, 2, 100), HasSubstr("a covariance of 7 rows"));
  map = two_landmarks();
  map.observations.pop_back();
  EXPECT_THAT(why(map, 2, 100), HasSubstr("2 landmarks"));
  map = two_landmarks();
  map.landmarks[1] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(why(map, 2, 100), HasSubstr("not finite"));
}

}  // namespace
}  // namespace waymark
