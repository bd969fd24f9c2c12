#include "waymark/slam/turn_bias.hpp"

#include <cmath>

namespace waymark {

bool TurnBias::stands(const Pose2& increment, double dt_s) const {
  return increment != Pose2{} && increment.position().norm() < standing_.below_mps * dt_s &&
         std::abs(increment.theta_rad) < standing_.below_radps * dt_s;
}

void TurnBias::observe(const Pose2& increment, double dt_s) {
  if (!stands(increment, dt_s)) return;
  turned_rad_ += increment.theta_rad;
  stood_s_ += dt_s;
}

}  // namespace waymark
