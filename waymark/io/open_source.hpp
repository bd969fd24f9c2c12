#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>

#include "waymark/core/config.hpp"
#include "waymark/core/result.hpp"
#include "waymark/core/source.hpp"
#include "waymark/io/bag/bag_options.hpp"

namespace waymark {

/// What a user may have to say about an input; its format is not among it.
struct InputOptions {
  int robot = 1;                 ///< of a MRCLAM directory
  int run = 1;                   ///< of a folder with several recordings, in the order of their names
  bool fix_known_errors = true;  ///< put right what is known to be wrong in a published recording
  double pixel_noise_px = 1.0;   ///< added where points were recorded without noise
  std::uint64_t seed = 1;        ///< of that noise; no key of its own, but that of the run
  BagOptions bag;
};

/// Keys input.*.
void describe(Schema& schema, InputOptions& options);

/// Opens a recording of any known format, recognised by what it holds: a Waymark log folder, an MRCLAM
/// dataset, a bag of ROS 1 or 2, the UWB labyrinth, planar-mono-slam, a Plaza run, lost-in-the-woods,
/// Victoria Park or the car park (the .mat file or its folder; Plaza also as text, Victoria Park also as its
/// graph).
[[nodiscard]] Result<std::unique_ptr<Source>> open_source(const std::filesystem::path& path,
                                                          const InputOptions& options = {});

}  // namespace waymark
