#pragma once

#include <string>
#include <utility>
#include <vector>

#include "waymark/core/result.hpp"

namespace waymark {

/// The settings of a published data set, which its reader hands on: configs/NAME.yaml, built in.
struct KnownSettings {
  const char* file;
  const char* yaml;

  /// As LogInfo has them.
  [[nodiscard]] Result<std::vector<std::pair<std::string, std::string>>> flat() const;
};

extern const KnownSettings kMrclamSettings;
extern const KnownSettings kPlazaSettings;
extern const KnownSettings kLostInTheWoodsSettings;
extern const KnownSettings kUwbLabyrinthSettings;
extern const KnownSettings kPlanarMonoSlamSettings;
extern const KnownSettings kVictoriaParkSettings;
extern const KnownSettings kCarParkSettings;

}  // namespace waymark
