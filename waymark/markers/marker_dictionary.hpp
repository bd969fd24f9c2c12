#pragma once

#include <span>
#include <string_view>

#include "waymark/core/result.hpp"

namespace waymark::markers {

enum class MarkerKind { kAruco, kAprilTag };

/// A published set of square patterns with numbers from 0.
struct MarkerDictionary {
  std::string_view name;  ///< as in `markers.dictionary`
  MarkerKind kind = MarkerKind::kAruco;
  int size = 0;            ///< patterns
  int bits_per_side = 0;   ///< without the black border
  int corrected_bits = 0;  ///< misread bits that still leave no doubt
};

/// All that can be asked for, a smaller set before a larger one that holds it too.
[[nodiscard]] std::span<const MarkerDictionary> marker_dictionaries();

/// The dictionary of that name; capitals, OpenCV's DICT_ and a missing apriltag_ do not matter. An unknown
/// name is an error that lists all.
[[nodiscard]] Result<MarkerDictionary> find_marker_dictionary(std::string_view name);

/// The smallest dictionary with the patterns of `dictionary` up to `number`.
[[nodiscard]] MarkerDictionary smallest_with(const MarkerDictionary& dictionary, int number);

}  // namespace waymark::markers
