#pragma once

#include <memory>

#include "waymark/core/result.hpp"

#include "workbench/datasets/mat_file.hpp"
#include "workbench/logs/source.hpp"

namespace waymark {

/// The file of the log.
inline constexpr const char* kVictoriaParkLog = "VictoriaParkSinSincronizar.mat";

/// Does the file hold the variables of VictoriaParkSinSincronizar.mat?
[[nodiscard]] bool is_victoria_park(const MatFile& file);

/// Opens the Victoria Park log (Guivant and Nebot 2001) with the trees as its authors detected them:
/// Steering, range-bearing Observations without identity, and, from aa3_gpsx.mat beside it where that is,
/// Truth without heading of the antenna, from the fixes that agree with their neighbours. The settings are
/// those of configs/victoria-park.yaml.
[[nodiscard]] Result<std::unique_ptr<Source>> open_victoria_park(const MatFile& file);

}  // namespace waymark
