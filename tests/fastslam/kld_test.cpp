#include "waymark/fastslam/kld.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace waymark::fastslam {
namespace {

TEST(KldParticles, AreThoseOfTheFormula) {
  // Fox 2003 with epsilon 0.05 and z 2.33, rounded up.
  EXPECT_EQ(std::ceil(kld_particles(10, 0.05)), 218.0);
  EXPECT_EQ(std::ceil(kld_particles(50, 0.05)), 750.0);
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
