#include "workbench/run/input_options.hpp"

namespace waymark {

void describe(Schema& schema, InputOptions& options) {
  schema.integer("input.robot", options.robot, {1, 99},
                 "number of the robot, where a recording holds several (MRCLAM)", Shown::kAlways);
  schema.integer("input.run", options.run, {1, 99},
                 "number of the recording in a folder that holds several, in alphabetical order",
                 Shown::kAlways);
  schema.boolean("input.fix_known_errors", options.fix_known_errors,
                 "correct known errors of a published recording", Shown::kAlways);
  schema.real("input.pixel_noise_px", options.pixel_noise_px, {0.0, 100.0},
              "standard deviation of the noise added to pixels that were recorded without noise "
              "(planar-mono-slam), px");
  describe(schema, options.bag);
}

}  // namespace waymark
