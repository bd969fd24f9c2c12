#pragma once

#include <cstdint>

#include "workbench/bags/bag_options.hpp"
#include "workbench/config/schema.hpp"

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

}  // namespace waymark
