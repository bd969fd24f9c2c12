#include "workbench/config/camera_keys.hpp"

#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "waymark/kernels/fast_corners.hpp"
#include "waymark/kernels/zmssd.hpp"
#include "waymark/markers/marker_dictionary.hpp"

namespace waymark {

void describe(Schema& schema, vision::SearchOptions& o) {
  schema.real("search.probability", o.probability, {0.5, 0.99999},
              "part of the true places that lie inside a search ellipse");
  schema.integer("search.max_windows", o.max_windows, {1.0, 1e6},
                 "places of one search; larger ellipses are searched at corners only");
  schema.choice("search.match", o.match, {"map", "article"},
                "what a match makes small: map (posterior) or article (weighted ZMSSD)");
  schema.real("search.grey_sigma", o.grey_sigma, {0.1, 100.0}, "noise of a pixel, grey levels");
  schema.real("search.accept_ratio", o.accept_ratio, {0.1, 1e6},
              "a match may differ from its patch so many times as much as noise and half a pixel explain");
}

void describe(Schema& schema, vision::FrameBudgetOptions& options) {
  schema.real("tracker.frame_budget_ms", options.per_frame_ms, {0.001, 10000.0},
              "time for a picture; what is left out when it is used up is looked for in later ones");
  schema.choice("tracker.budget", options.kind, {"work", "clock"},
                "how it is counted: work (fixed costs, the same in every replay) or clock (CPU time)");
}

void describe(Schema& schema, vision::TrackerOptions& o) {
  schema.integer("tracker.patch_px", o.finder.patch_px, {kernels::kMinPatchSize, kernels::kMaxPatchSize},
                 "side of the square around a landmark that is compared");
  schema.boolean("tracker.warp", o.finder.warp, "turns and scales patches to the viewpoint");
  schema.boolean("tracker.subpixel", o.finder.subpixel, "finds places between the pixels");
  schema.choice("tracker.kernels", o.instructions, {"simd", "scalar"},
                "code that compares patches and finds corners: simd, or scalar for comparison");
  schema.integer("tracker.most_observed", o.most_observed, {1.0, 10000.0},
                 "landmarks that are looked for in one picture");
  describe(schema, o.budget);
  describe(schema, o.new_corners);
  describe(schema, o.corners);
}

void describe(Schema& schema, vision::NewCornerOptions& o) {
  schema.integer("tracker.wanted", o.wanted, {1.0, 1000.0},
                 "landmarks in view; with fewer, new corners are looked for where there are none");
  schema.integer("tracker.most_candidates", o.most_candidates, {1.0, 100.0},
                 "corners whose distance is being found out at a time");
  schema.integer("tracker.most_new", o.most_new, {1.0, 100.0}, "new corners in one picture");
  schema.integer("tracker.cells_u", o.columns, {1.0, 64.0},
                 "cells side by side into which a picture is cut to tell where corners are wanted");
  schema.integer("tracker.cells_v", o.rows, {1.0, 64.0}, "and one below the other");
  schema.real("tracker.distance_px", o.distance_px, {1.0, 1000.0},
              "least distance of a new corner from other landmarks in the picture");
}

void describe(Schema& schema, vision::CornerOptions& options) {
  schema.integer("corners.threshold", options.threshold, {1.0, 254.0},
                 "grey levels by which the pixels around a corner differ from it");
  schema.integer("corners.arc", options.arc, {kernels::kMinFastArc, kernels::kMaxFastArc},
                 "neighbouring pixels of the circle of 16 that must differ");
}

void describe(Schema& schema, markers::MarkerOptions& o) {
  std::vector<std::string_view> names;
  for (const markers::MarkerDictionary& each : markers::marker_dictionaries()) names.push_back(each.name);
  schema.text("markers.dictionary", o.dictionary,
              fmt::format("which markers there are: {}", fmt::join(names, ", ")));
  schema.real("markers.size_m", o.size_m, {0.0, 100.0},
              "side of the black square of a marker, m; 0: nobody said");
  schema.text("markers.sizes_m", o.sizes_m, "sides of those that differ, m, as '3: 0.1, 7: 0.25'");
  schema.real("markers.side_sigma_px", o.side_sigma_px, {1e-3, 100.0},
              "standard deviation of one point on a side of a marker, pixels");
  schema.real("markers.corner_sigma_px", o.corner_sigma_px, {1e-3, 100.0},
              "noise of a corner of a marker that another program found, px, where a bag has no pictures");
  schema.real("markers.mount_sigma_deg", o.mount_sigma_deg, {0.0, 10.0},
              "standard deviation of how the camera shakes on its robot, degrees");
  schema.real("markers.max_tilt_deg", o.max_tilt_deg, {0.0, 90.0},
              "a marker that is turned further from the camera is not used, degrees");
  schema.integer("markers.confirm", o.confirm, {1, 1000},
                 "pictures close together that must show a new identity before it is believed");
  schema.boolean("markers.own_thread", o.own_thread,
                 "find markers on a thread of its own, ahead of the filter; the result is the same");
}

}  // namespace waymark
