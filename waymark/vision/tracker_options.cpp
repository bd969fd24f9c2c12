#include "waymark/vision/tracker_options.hpp"

#include "waymark/kernels/zmssd.hpp"

namespace waymark::vision {

void describe(Schema& schema, TrackerOptions& o) {
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

}  // namespace waymark::vision
