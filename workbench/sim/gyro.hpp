#pragma once

#include <cstdint>
#include <vector>

#include "waymark/core/event.hpp"

#include "workbench/sim/drive.hpp"
#include "workbench/sim/options.hpp"

namespace waymark::sim {

/// The readings of a gyro from stamp 0 to the end of the drive: the mean rate of the true heading over the
/// time between two readings, about each one's stamp, with white noise and a bias that walks. One that is
/// stuck (FaultOptions) repeats what it told last. Nothing at a rate of 0.
[[nodiscard]] std::vector<Event> gyro_readings(const GyroOptions& options, const FaultOptions& faults,
                                               const Drive& drive, std::uint64_t seed);

}  // namespace waymark::sim
