#include "waymark/association/recovery.hpp"

#include <algorithm>

namespace waymark {
namespace {

constexpr int kMaxGatedInARow = 5;
const Eigen::Vector3d kFirstInflation(0.02, 0.02, 0.02);  // sigma of x, y, theta: m, rad

}  // namespace

bool Recovery::is_lost(std::span<const Innovation> innovations) {
  for (const Innovation& innovation : innovations) {
    if (innovation.outcome == Outcome::kMatched) gated_in_a_row_ = 0;
    if (innovation.outcome == Outcome::kGated) ++gated_in_a_row_;
  }
  return gated_in_a_row_ >= kMaxGatedInARow && is_mostly_gated(innovations);
}

bool Recovery::is_mostly_gated(std::span<const Innovation> innovations) {
  const auto count = [&](Outcome outcome) {
    return std::ranges::count(innovations, outcome, &Innovation::outcome);
  };
  return count(Outcome::kGated) > count(Outcome::kMatched);
}

Motion Recovery::first_inflation() {
  Motion added_motion;
  added_motion.covariance = kFirstInflation.cwiseAbs2().asDiagonal();
  return added_motion;
}

}  // namespace waymark
