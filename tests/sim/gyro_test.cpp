#include "workbench/sim/gyro.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "waymark/core/angle.hpp"

#include "workbench/sim/path.hpp"

namespace waymark::sim {
namespace {

constexpr GyroOptions kPerfect{.rate_hz = 100.0,
                               .noise_deg_per_sqrt_s = 0.0,
                               .bias_sigma_degps = 0.0,
                               .bias_walk_degps_per_sqrt_s = 0.0};

Drive square_drive(double stand_s = 0.0) {
  SimOptions options;
  options.path.stand_s = stand_s;
  return drive(make_path(options.path, 1), options, 1);
}

std::vector<double> rates(const GyroOptions& options, const Drive& driven, const FaultOptions& faults = {}) {
  std::vector<double> all_radps;
  for (const Event& event : gyro_readings(options, faults, driven, 1))
    all_radps.push_back(std::get<YawRate>(event.content).w_radps);
  return all_radps;
}

TEST(SimGyro, IsNotThereWithoutARate) { EXPECT_TRUE(rates({}, square_drive()).empty()); }

TEST(SimGyro, ItsIntegralIsTheTrueHeading) {
  const Drive driven = square_drive();
  double turn_rad = 0.0;
  for (const double rate_radps : rates(kPerfect, driven)) turn_rad += rate_radps / kPerfect.rate_hz;
  // One counter-clockwise lap, and what the robot is off the path at its end.
  EXPECT_NEAR(turn_rad, 2.0 * kPi + wrap_angle(driven.at(driven.end()).theta_rad - driven.at({}).theta_rad),
              0.01);
}

TEST(SimGyro, NoiseAndBiasAreAsStated) {
  constexpr double kStand_s = 200.0;
  GyroOptions options = kPerfect;
  options.noise_deg_per_sqrt_s = 0.1;
  options.bias_sigma_degps = 2.0;
  const auto all_radps = rates(options, square_drive(kStand_s));
  const auto count = static_cast<std::size_t>(kStand_s * options.rate_hz);
  double sum = 0.0;
  double squares = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    sum += all_radps[i];
    squares += all_radps[i] * all_radps[i];
  }
  const double mean_radps = sum / static_cast<double>(count);
  const double sigma_radps = std::sqrt(squares / static_cast<double>(count) - mean_radps * mean_radps);
  EXPECT_NEAR(to_degrees(sigma_radps), 0.1 * std::sqrt(options.rate_hz), 0.03);  // five of 20000 draws' own
  EXPECT_GT(std::abs(to_degrees(mean_radps)), 0.04) << "five of the mean's own: a bias";
  EXPECT_LT(std::abs(to_degrees(mean_radps)), 8.0);
}

TEST(SimGyro, ThatIsStuckRepeatsItself) {
  GyroOptions options = kPerfect;
  options.noise_deg_per_sqrt_s = 0.1;
  const auto all_radps = rates(options, square_drive(), {.gyro_stuck_at_s = 10.0});
  for (std::size_t i = 1; i < all_radps.size(); ++i)
    EXPECT_EQ(all_radps[i] == all_radps[i - 1], i > 1000) << i;
}

}  // namespace
}  // namespace waymark::sim
