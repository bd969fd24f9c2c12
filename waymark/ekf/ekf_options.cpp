#include "waymark/ekf/ekf_options.hpp"

namespace waymark {

void describe(Schema& schema, EkfOptions& options) {
  schema.choice(
      "ekf.consistency", options.consistency, {"invariant", "fej", "standard"},
      "where the filter linearises: invariant error, first estimates, or latest estimates as in the article");
  schema.integer("ekf.capacity", options.capacity, {1, 20000},
                 "most landmarks in the map; memory is taken once");
  schema.choice(
      "ekf.evict", options.evict, {"information", "article", "none"},
      "which landmark leaves a full map: the one that told least about the pose, the one of largest I - K H "
      "as in the article, or none, so that new ones are refused");
  schema.integer("ekf.iterations", options.iterations, {0, 20},
                 "how often an update may be linearised anew where it leaves the linear; 0: never");
  schema.choice(
      "ekf.likelihood", options.likelihood, {"gaussian", "student"},
      "student: heavy tails, for outliers that no gate finds; takes up to 3 iterations in any case");
  schema.choice(
      "ekf.update", options.update, {"fast", "textbook"},
      "textbook: of pixels, with dense matrices and plain loops as in the article, to compare with; "
      "needs ekf.consistency=standard");
  schema.choice("ekf.compressed", options.compressed, {"auto", "true", "false"},
                "whether a large map is updated region by region, at the cost of a small one; auto: once it "
                "is large enough to gain");
  describe(schema, options.odometry);
  schema.integer("ekf.region", options.region, {48, 20000},
                 "landmarks in a region of a compressed map; more where so many are seen at once");
}

}  // namespace waymark
