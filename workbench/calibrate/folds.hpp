#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace waymark::calibrate {

/// Some places are left out, the rest stay.
struct Fold {
  std::vector<std::size_t> rest;
  std::vector<std::size_t> left_out;
};

/// More folds than these cost time and tell little.
inline constexpr std::size_t kMaxFolds = 10;

/// Each place is left out once, in as many folds as there are places, or in kMaxFolds; neighbours together:
/// what follows each other is most alike.
[[nodiscard]] inline std::vector<Fold> folds_of(const std::vector<std::size_t>& places) {
  const std::size_t count = std::min(places.size(), kMaxFolds);
  std::vector<Fold> folds(count);
  for (std::size_t i = 0; i < places.size(); ++i)
    for (std::size_t fold = 0; fold < count; ++fold) {
      const bool is_out = i >= fold * places.size() / count && i < (fold + 1) * places.size() / count;
      (is_out ? folds[fold].left_out : folds[fold].rest).push_back(places[i]);
    }
  return folds;
}

}  // namespace waymark::calibrate
