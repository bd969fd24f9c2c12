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
  schema.real("search.grey_sigma", o.grey_sigma, {0.1, 100.0},
              "standard deviation of the noise of a pixel, grey levels");
  schema.real("search.accept_ratio", o.accept_ratio, {0.1, 1e6},
              "largest ZMSSD of a match, relative to that expected from image noise and half a pixel of "
              "offset; more finds more and matches more wrongly");
}

void describe(Schema& schema, vision::FrameBudgetOptions& options) {
  schema.real("tracker.frame_budget_ms", options.per_frame_ms, {0.001, 10000.0},
              "time budget for an image, ms; what does not fit is searched for in later images",
              Shown::kAlways);
  schema.choice("tracker.budget", options.kind, {"work", "clock"},
                "how the budget is counted: work (fixed cost per operation, the same in every replay) or "
                "clock (CPU time)",
                Shown::kAlways);
}

void describe(Schema& schema, vision::TrackerOptions& o) {
  describe(schema, o.budget);
  describe(schema, o.new_corners);
  describe(schema, o.corners);
}

void describe(Schema& schema, vision::NewCornerOptions& o) {
  schema.integer("tracker.wanted", o.wanted, {1.0, 1000.0},
                 "number of landmarks wanted in view; with fewer, new corners are searched for in empty "
                 "parts of the image");
}

void describe(Schema& schema, vision::CornerOptions& options) {
  schema.integer("corners.threshold", options.threshold, {1.0, 254.0},
                 "FAST threshold: difference in grey levels between a corner and the pixels around it");
}

void describe(Schema& schema, markers::MarkerOptions& o) {
  std::vector<std::string_view> names;
  for (const markers::MarkerDictionary& each : markers::marker_dictionaries()) names.push_back(each.name);
  schema.text("markers.dictionary", o.dictionary,
              fmt::format("dictionary of the markers, required to find them: {}", fmt::join(names, ", ")),
              Shown::kAlways);
  schema.real("markers.size_m", o.size_m, {0.0, 100.0},
              "side of the black square of a marker, m; 0: unset, then markers.sizes_m is required",
              Shown::kAlways);
  schema.text("markers.sizes_m", o.sizes_m,
              "sides of markers of other sizes, m, as '3: 0.1, 7: 0.25' (identity: side); empty: all have "
              "markers.size_m",
              Shown::kAlways);
  schema.real("markers.side_sigma_px", o.side_sigma_px, {1e-3, 100.0},
              "standard deviation of a point found on a marker's side, px");
  schema.real(
      "markers.corner_sigma_px", o.corner_sigma_px, {1e-3, 100.0},
      "standard deviation of marker corners that another program detected, px; for bags without images");
  schema.real("camera.jitter_deg", o.jitter_deg, {0.0, 10.0},
              "standard deviation of the camera jitter, drawn anew in every image, degrees");
  schema.integer("markers.confirm", o.confirm, {1, 1000},
                 "number of images, at most 15 apart, in which a new identity must be found before it is "
                 "used; more rejects false positives");
}

}  // namespace waymark
