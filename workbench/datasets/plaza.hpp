#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "waymark/core/result.hpp"

#include "workbench/datasets/mat_file.hpp"
#include "workbench/logs/source.hpp"

namespace waymark {

/// Does the file hold the variables of a Plaza run: GT, DR and TD?
[[nodiscard]] bool is_plaza(const MatFile& file);

/// The runs of a folder that are there as text: the paths before _DR.txt and _TD.txt, sorted.
[[nodiscard]] std::vector<std::filesystem::path> plaza_text_runs(const std::filesystem::path& folder);

/// Opens a run of a robot mower among four ranging radios (Djugash, Hamner, Roth 2009) as redistributed with
/// GTSAM. OdometryPose, Truth, and Observations of ranges as they were measured, about 7 % too long;
/// configs/plaza.yaml, which makes up the settings, has scale and offset. Ids are those of the beacons.
/// Ranges out of order are put in their place. A robot that drives backwards (Plaza 2) goes negative
/// distances; without `fix_known_errors` they stay positive, as published.
[[nodiscard]] Result<std::unique_ptr<Source>> open_plaza(const MatFile& file, bool fix_known_errors);

/// The same from the text files, which hold neither truth nor beacons: `path` is "folder/Plaza1".
[[nodiscard]] Result<std::unique_ptr<Source>> open_plaza_text(const std::filesystem::path& path,
                                                              bool fix_known_errors);

}  // namespace waymark
