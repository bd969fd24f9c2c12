#pragma once

#include <filesystem>
#include <memory>

#include "waymark/core/result.hpp"

#include "workbench/logs/source.hpp"

namespace waymark {

/// Does the folder hold Indoor_UWB_Input.txt?
[[nodiscard]] bool is_uwb_labyrinth(const std::filesystem::path& folder);

/// Opens the labyrinth dataset of libRSF (Pfeifer, TU Chemnitz): a small robot among four radios. WheelAngles
/// (the speeds of the wheels summed up to metres: wheels of 1 m radius), Observations of ranges, Truth
/// without heading. The surveyed anchors stand in the rows of their ranges. The settings are those of
/// configs/uwb-labyrinth.yaml: among them the track, which the file states as half of what it is.
[[nodiscard]] Result<std::unique_ptr<Source>> open_uwb_labyrinth(const std::filesystem::path& folder);

}  // namespace waymark
