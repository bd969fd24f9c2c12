#include "workbench/run/article_methods.hpp"

namespace waymark {

bool uses_article_methods(const Config& config) {
  return config.odometry.arc == ArcModel::kArticle && config.search.match == vision::MatchScore::kArticle &&
         !config.tracker.finder.warp && !config.tracker.finder.subpixel &&
         config.tracker.instructions == kernels::Instructions::kScalar &&
         config.pixel.init == ekf::Initialization::kArticle &&
         config.pixel.depth.spacing == ekf::DepthPrior::Spacing::kDepth &&
         config.pixel.update == UpdateMethod::kTextbook;
}

void use_article_methods(Config& config, bool use) {
  config.odometry.arc = use ? ArcModel::kArticle : ArcModel::kExact;
  config.search.match = use ? vision::MatchScore::kArticle : vision::MatchScore::kMap;
  config.tracker.finder.warp = config.tracker.finder.subpixel = !use;
  config.tracker.instructions = use ? kernels::Instructions::kScalar : kernels::Instructions::kSimd;
  config.pixel.init = use ? ekf::Initialization::kArticle : ekf::Initialization::kDelayed;
  config.pixel.depth.spacing =
      use ? ekf::DepthPrior::Spacing::kDepth : ekf::DepthPrior::Spacing::kInverseDepth;
  config.pixel.update = use ? UpdateMethod::kTextbook : UpdateMethod::kFast;
}

}  // namespace waymark
