#include "waymark/fastslam/kld.hpp"

#include <gtest/gtest.h>

namespace waymark::fastslam {
namespace {

TEST(KldParticles, AreThoseOfTheFormula) {
  // With Fox's epsilon of 0.05 and his z, 2.33, rounded up: 218 and 750.
  EXPECT_NEAR(kld_particles(10, 0.05), 217.2, 0.5);
  EXPECT_NEAR(kld_particles(50, 0.05), 749.5, 1.0);
  EXPECT_EQ(kld_particles(1, 0.05), 1.0);
}

TEST(OccupiedBins, CountsPlacesAndHeadings) {
  Particles particles(6, Pose2{0.1, 0.1, 0.01});
  OccupiedBins bins(6);
  EXPECT_EQ(bins.count(particles), 1U);
  particles.set_pose(1, {0.15, 0.1, 0.01});  // the same bin
  particles.set_pose(2, {0.25, 0.1, 0.01});  // another place
  particles.set_pose(3, {0.1, -0.1, 0.01});  // another place
  particles.set_pose(4, {0.1, 0.1, -0.01});  // another heading
  EXPECT_EQ(bins.count(particles), 4U);
  particles.weights()[4] = 0.0;
  EXPECT_EQ(bins.count(particles), 3U);
}

}  // namespace
}  // namespace waymark::fastslam
