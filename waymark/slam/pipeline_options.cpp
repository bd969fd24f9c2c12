#include "waymark/slam/pipeline_options.hpp"

namespace waymark {

bool tells_size(Observe observe, const SensorErrors& errors) {
  return observe != Observe::kBearing && !(errors.shared_range_sigma_ratio > 0.0);
}

void describe(Schema& schema, PipelineOptions& options) {
  schema.real("pipeline.reorder_window_s", options.reorder_window_s, {0.0, 60.0},
              "how late an event may arrive and still be put in its place, s");
  schema.real("pipeline.max_hold_s", options.max_hold_s, {0.0, 3600.0},
              "how long the last speed is believed when odometry is missing, s");
}

}  // namespace waymark
