#pragma once

#include <filesystem>
#include <memory>

#include "waymark/core/result.hpp"

#include "workbench/logs/source.hpp"

namespace waymark {

/// How to read a recording that holds more than one log, or is known to have errors.
struct MrclamOptions {
  int robot = 1;
  /// Dataset 1 was published with landmarks 11 and 17 exchanged.
  bool fix_known_errors = true;
};

/// Does the folder look like a published MRCLAM dataset: Barcodes.dat and RobotN_Odometry.dat?
[[nodiscard]] bool is_mrclam(const std::filesystem::path& folder);

/// Opens one robot of a folder of the UTIAS Multi-Robot Cooperative Localization and Mapping dataset (Leung,
/// Halpern, Barfoot, Liu 2011) as published. Velocity, Truth and range-bearing Observations; ids are subjects
/// of the barcode family. Observations of other robots and of barcodes that are in no table, and odometry
/// that goes back in time, are skipped and counted in notes(). Where RobotN_Groundtruth.dat is missing, the
/// truth is RobotN_Groundtruth_rounded.csv, whose stamps are rebuilt (rounded_stamps.hpp). The settings are
/// those of configs/mrclam.yaml, one set for all robots.
[[nodiscard]] Result<std::unique_ptr<Source>> open_mrclam(const std::filesystem::path& folder,
                                                          const MrclamOptions& options = {});

}  // namespace waymark
