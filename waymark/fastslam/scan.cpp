#include "waymark/fastslam/scan.hpp"

#include <algorithm>

namespace waymark::fastslam {

void Scan::begin(std::span<const Observation> next) {
  observations = next;
  innovations.assign(next.size(), {});
  landmarks.assign(next.size(), kNone);
  last_claims.assign(next.size(), 0);
  moments.assign(next.size(), {});
}

int Scan::count(Outcome outcome) const {
  return static_cast<int>(std::ranges::count(innovations, outcome, &Innovation::outcome));
}

bool Scan::has_before(std::size_t index, LandmarkId id) const {
  return std::any_of(innovations.begin(), innovations.begin() + static_cast<std::ptrdiff_t>(index),
                     [id](const Innovation& earlier) {
                       return earlier.landmark == id &&
                              (earlier.outcome == Outcome::kMatched || earlier.outcome == Outcome::kAdded);
                     });
}

void Scan::match(std::size_t index, int landmark, LandmarkTable& table) {
  landmarks[index] = landmark;
  last_claims[index] = table[landmark].claimed_at_scan;
  table.claim(landmark);
  innovations[index].landmark = table[landmark].id;
  innovations[index].outcome = Outcome::kMatched;
}

}  // namespace waymark::fastslam
