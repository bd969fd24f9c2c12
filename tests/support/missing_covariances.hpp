#pragma once

#include <vector>

#include <gtest/gtest.h>

#include "support/circle_world.hpp"

namespace waymark::test {

/// Of two like filters over `sensor` one is told its noise with every observation, the other one is not: they
/// must come to the same bits.
template <class FilterType>
void expect_the_noise_of_the_sensor(FilterType& told, FilterType& silent, CircleWorld& world,
                                    const LandmarkSensor& sensor) {
  for (int i = 0; i < 30; ++i) {
    const Motion motion = world.move();
    std::vector<Observation> scan = world.look();
    for (FilterType* each : {&told, &silent}) each->predict(motion);
    for (Observation& each : scan) each.covariance = noise_covariance(sensor, each.value);
    told.correct(scan);
    for (Observation& each : scan) each.covariance.reset();
    EXPECT_EQ(silent.correct(scan).count(Outcome::kUnusable), 0);
  }
  EXPECT_EQ(silent.pose().T_world_robot, told.pose().T_world_robot);
  EXPECT_EQ(silent.pose().covariance, told.pose().covariance);
}

}  // namespace waymark::test
