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
  const Config usual;
  config.odometry.arc = use ? ArcModel::kArticle : usual.odometry.arc;
  config.search.match = use ? vision::MatchScore::kArticle : usual.search.match;
  config.tracker.finder.warp = !use && usual.tracker.finder.warp;
  config.tracker.finder.subpixel = !use && usual.tracker.finder.subpixel;
  config.tracker.instructions = use ? kernels::Instructions::kScalar : usual.tracker.instructions;
  config.pixel.init = use ? ekf::Initialization::kArticle : usual.pixel.init;
  config.pixel.depth.spacing = use ? ekf::DepthPrior::Spacing::kDepth : usual.pixel.depth.spacing;
  config.pixel.update = use ? UpdateMethod::kTextbook : usual.pixel.update;
}

}  // namespace waymark
