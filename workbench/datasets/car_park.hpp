#pragma once

#include <memory>

#include "waymark/core/result.hpp"

#include "workbench/datasets/mat_file.hpp"
#include "workbench/logs/source.hpp"

namespace waymark {

/// The file of the log.
inline constexpr const char* kCarParkLog = "data_set.mat";

/// Does the file hold the variables of the car park's data_set.mat?
[[nodiscard]] bool is_car_park(const MatFile& file);

/// Opens the car park log (Guivant, Nebot and Baiker 2000): Steering, range-bearing Observations, without
/// identity, of the reflectors in each scan, and Truth without heading of the antenna. The surveyed beacons
/// come from beac_juan3.mat where that lies beside it. The settings are those of configs/car-park.yaml.
[[nodiscard]] Result<std::unique_ptr<Source>> open_car_park(const MatFile& file);

}  // namespace waymark
