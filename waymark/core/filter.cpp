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
      return "outside its gate";
    case Outcome::kUnidentified:
      return "without identity";
    case Outcome::kUnusable:
      return "unusable";
    case Outcome::kAmbiguous:
      return "ambiguous";
    case Outcome::kDuplicate:
      return "seen twice in one scan";
    case Outcome::kDeferred:
      return "kept until its landmark can be located";
    case Outcome::kMapFull:
      return "map full";
    case Outcome::kNotInMap:
      return "of a landmark that the held map does not have";
  }
  return "unknown";
}

int Correction::count(Outcome outcome) const {
  return static_cast<int>(
      std::ranges::count_if(innovations, [outcome](const Innovation& i) { return i.outcome == outcome; }));
}

}  // namespace waymark
