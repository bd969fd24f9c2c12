#pragma once

#include <memory>

#include "waymark/core/result.hpp"

#include "workbench/datasets/mat_file.hpp"
#include "workbench/logs/source.hpp"

namespace waymark {

/// Does the file hold the variables of the lost-in-the-woods log?
[[nodiscard]] bool is_lost_in_the_woods(const MatFile& file);

/// Opens dataset2.mat of the course AER1513 of the University of Toronto (Barfoot): an indoor robot with a
/// laser among 17 tubes. Velocity, range-bearing Observations from the laser with identities 1 to 17, and
/// Truth where the motion capture had one. The settings are those of configs/lost-in-the-woods.yaml, with the
/// place of the laser as the file has it.
[[nodiscard]] Result<std::unique_ptr<Source>> open_lost_in_the_woods(const MatFile& file);

}  // namespace waymark
