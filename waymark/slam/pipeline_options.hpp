#pragma once

namespace waymark {

struct PipelineOptions {
  double reorder_window_s = 0.5;  ///< how late an event may arrive and still be put in its place
  double max_hold_s = 2.0;        ///< how long the last speed is believed when odometry is missing
};

}  // namespace waymark
