#include "waymark/association/recovery.hpp"

#include <algorithm>

namespace waymark {

bool is_mostly_gated(std::span<const Innovation> innovations) {
  const auto count = [&](Outcome outcome) {
    return std::ranges::count(innovations, outcome, &Innovation::outcome);
  };
  return count(Outcome::kGated) > count(Outcome::kMatched);
}

}  // namespace waymark
