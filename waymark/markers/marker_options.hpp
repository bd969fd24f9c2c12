#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "waymark/core/result.hpp"
#include "waymark/markers/marker_dictionary.hpp"

namespace waymark::markers {

/// What markers there are, and how well they are seen.
struct MarkerOptions {
  std::string dictionary;        ///< empty: not said
  double size_m = 0.0;           ///< side of the black square; 0: not said
  std::string sizes_m;           ///< of those that differ, "id: size, id: size"
  double side_sigma_px = 0.08;   ///< of one point on a side
  double corner_sigma_px = 0.3;  ///< of a corner that another program found
  double jitter_deg = 0.05;      ///< of the camera on its robot from image to image
  int confirm = 1;               ///< images that must show an identity before it is believed
  bool own_thread = true;        ///< detection runs ahead of the filter
};

/// Options that were understood.
struct MarkerSet {
  MarkerDictionary dictionary;
  double size_m = 0.0;
  std::map<std::int32_t, double> sizes_m;

  /// 0: unset.
  [[nodiscard]] double size_of(std::int32_t id) const;
};

/// The markers that the options describe, or what is missing or wrong.
[[nodiscard]] Result<MarkerSet> marker_set(const MarkerOptions& options);

}  // namespace waymark::markers
