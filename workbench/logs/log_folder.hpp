#pragma once

#include <filesystem>
#include <memory>

#include "waymark/core/result.hpp"

#include "workbench/logs/source.hpp"

namespace waymark {

/// Does the folder hold any file of a Waymark log?
[[nodiscard]] bool is_log_folder(const std::filesystem::path& folder);

/// Does its log.yaml say that it is one, whatever else lies in the folder?
[[nodiscard]] bool names_log_folder(const std::filesystem::path& folder);

/// Opens a Waymark log folder (docs/log-format.md): log.yaml, at most one of wheels.csv, velocity.csv,
/// steering.csv and odometry.csv, and what there is of observations.csv, truth.csv, images.csv with
/// camera.yaml and landmarks.csv. Events come in the order of time; at equal stamps odometry, then truth,
/// observations and images, which are named and not read (logs/image_loader.hpp does). Images that are
/// missing or repeat a stamp are skipped and counted; bags in the folder are named and not read. Ids are read
/// as marker numbers. Errors name file and
/// line; those of single rows come out of next().
[[nodiscard]] Result<std::unique_ptr<Source>> open_log_folder(const std::filesystem::path& folder);

}  // namespace waymark
