#pragma once

#include "waymark/markers/marker_options.hpp"
#include "waymark/vision/corner_options.hpp"
#include "waymark/vision/frame_budget.hpp"
#include "waymark/vision/new_corner_options.hpp"
#include "waymark/vision/search_options.hpp"
#include "waymark/vision/tracker_options.hpp"

#include "workbench/config/schema.hpp"

namespace waymark {

void describe(Schema& schema, vision::SearchOptions& options);
void describe(Schema& schema, vision::FrameBudgetOptions& options);
/// Adds `tracker.` and `corners.` keys.
void describe(Schema& schema, vision::TrackerOptions& options);
void describe(Schema& schema, vision::NewCornerOptions& options);
void describe(Schema& schema, vision::CornerOptions& options);
/// Keys markers.*.
void describe(Schema& schema, markers::MarkerOptions& options);

}  // namespace waymark
