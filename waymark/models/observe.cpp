#include "waymark/models/observe.hpp"

namespace waymark {

bool observes_scale(Observe observe, const SensorErrors& errors) {
  return observe != Observe::kBearing && !(errors.shared_range_sigma_ratio > 0.0);
}

}  // namespace waymark
