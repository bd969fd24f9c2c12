#include "workbench/run/input_options.hpp"

namespace waymark {

void describe(Schema& schema, InputOptions& options) {
  schema.integer("input.robot", options.robot, {1, 99}, "which robot, where a recording holds several",
                 Shown::kAlways);
  schema.integer("input.run", options.run, {1, 99},
                 "which recording of a folder that holds several, in the order of their names",
                 Shown::kAlways);
  schema.boolean("input.fix_known_errors", options.fix_known_errors,
                 "put right what is known to be wrong in a published recording");
  schema.real(
      "input.pixel_noise_px", options.pixel_noise_px, {0.0, 100.0},
      "standard deviation of the noise that is added to points recorded without any (planar-mono-slam), "
      "px");
  describe(schema, options.bag);
}

}  // namespace waymark
