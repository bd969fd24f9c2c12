#pragma once

#include "waymark/core/expectation.hpp"
#include "waymark/models/camera.hpp"
#include "waymark/vision/finder_options.hpp"
#include "waymark/vision/frame_budget.hpp"
#include "waymark/vision/search.hpp"
#include "waymark/vision/search_record.hpp"
#include "waymark/vision/visual_memory.hpp"

namespace waymark::vision {

/// Where a landmark was found, or what came of searching for it.
struct SearchResult {
  SearchRecord::Result result = SearchRecord::Result::kNotTried;
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();  ///< found, or the best place
  Eigen::Matrix2d R = Eigen::Matrix2d::Zero();      ///< covariance of a found place, px^2
  double cost_ns = 0.0;                             ///< of looking, as WorkCosts count
};

/// Looks for one landmark at a time: its patch as it should look from here, the search in the ellipse where
/// it is expected, the sub-pixel peak. One per thread.
class LandmarkFinder {
 public:
  LandmarkFinder(const FinderOptions& options, const SearchOptions& search, const Camera& camera);

  /// What search_for() will take.
  [[nodiscard]] double expected_cost_ns(const Expectation& expected) const;

  /// In an image that was taken from `here`. It is found where the best place resembles it (SearchOptions::
  /// accept_ratio), at the bottom of its sub-pixel peak if there is one to be found. It counts as missed
  /// where its whole patch should be in the image but was not found.
  [[nodiscard]] SearchResult search_for(const Expectation& expected, const ImageView& image,
                                        const CameraPose& here, Appearance& appearance);

 private:
  [[nodiscard]] bool redraw(const Expectation& expected, const CameraPose& here,
                            Appearance& appearance) const;
  void locate(const ImageView& image, const Patch& patch, const Match& match,
              SearchResult& search_result) const;

  FinderOptions options_;
  SearchOptions search_options_;
  Camera camera_;
  WorkCosts costs_;
  Search search_;
};

}  // namespace waymark::vision
