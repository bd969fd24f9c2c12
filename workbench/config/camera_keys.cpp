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
  schema.real("search.grey_sigma", o.grey_sigma, {0.1, 100.0}, "noise of a pixel, grey levels");
  schema.real("search.accept_ratio", o.accept_ratio, {0.1, 1e6},
              "a match may differ from its patch so many times as much as noise and half a pixel explain");
}

void describe(Schema& schema, vision::FrameBudgetOptions& options) {
  schema.real("tracker.frame_budget_ms", options.per_frame_ms, {0.001, 10000.0},
              "time for an image; what is left out when it is used up is looked for in later ones",
              Shown::kAlways);
  schema.choice("tracker.budget", options.kind, {"work", "clock"},
                "how it is counted: work (fixed costs, the same in every replay) or clock (CPU time)",
                Shown::kAlways);
}

void describe(Schema& schema, vision::TrackerOptions& o) {
  describe(schema, o.budget);
  describe(schema, o.new_corners);
  describe(schema, o.corners);
}

void describe(Schema& schema, vision::NewCornerOptions& o) {
  schema.integer("tracker.wanted", o.wanted, {1.0, 1000.0},
                 "landmarks in view; with fewer, new corners are looked for where there are none");
}

void describe(Schema& schema, vision::CornerOptions& options) {
  schema.integer("corners.threshold", options.threshold, {1.0, 254.0},
                 "grey levels by which the pixels around a corner differ from it");
}

void describe(Schema& schema, markers::MarkerOptions& o) {
  std::vector<std::string_view> names;
  for (const markers::MarkerDictionary& each : markers::marker_dictionaries()) names.push_back(each.name);
  schema.text("markers.dictionary", o.dictionary,
              fmt::format("which markers there are: {}", fmt::join(names, ", ")), Shown::kAlways);
  schema.real("markers.size_m", o.size_m, {0.0, 100.0}, "side of the black square of a marker, m; 0: unset",
              Shown::kAlways);
  schema.text("markers.sizes_m", o.sizes_m, "sides of those that differ, m, as '3: 0.1, 7: 0.25'",
              Shown::kAlways);
  schema.real("markers.side_sigma_px", o.side_sigma_px, {1e-3, 100.0},
              "standard deviation of one point on a side of a marker, pixels");
  schema.real("markers.corner_sigma_px", o.corner_sigma_px, {1e-3, 100.0},
              "noise of a corner of a marker that another program found, px, where a bag has no images");
  schema.integer("markers.confirm", o.confirm, {1, 1000},
                 "images close together that must show a new identity before it is believed");
}

}  // namespace waymark
