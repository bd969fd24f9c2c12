#include "waymark/core/filter.hpp"

#include <algorithm>

namespace waymark {

const char* describe(Outcome outcome) {
  switch (outcome) {
    case Outcome::kMatched:
      return "matched";
    case Outcome::kAdded:
      return "added";
    case Outcome::kGated:
      return "rejected by the gate";
    case Outcome::kUnidentified:
      return "of unknown identity";
    case Outcome::kUnusable:
      return "unusable";
    case Outcome::kAmbiguous:
      return "ambiguous";
    case Outcome::kDuplicate:
      return "landmark observed twice in one scan";
    case Outcome::kDeferred:
      return "kept until the position of its landmark can be estimated";
    case Outcome::kMapFull:
      return "the map is full (map.capacity)";
    case Outcome::kNotInMap:
      return "its landmark is not in the map";
    case Outcome::kDistrusted:
      return "of landmarks that were found at several places";
  }
  return "unknown";
}

int Correction::count(Outcome outcome) const {
  return static_cast<int>(
      std::ranges::count_if(innovations, [outcome](const Innovation& i) { return i.outcome == outcome; }));
}

}  // namespace waymark
