#pragma once

#include <span>
#include <vector>

#include "waymark/core/expectation.hpp"
#include "waymark/core/filter.hpp"
#include "waymark/core/function_blocks.hpp"
#include "waymark/core/grey_image.hpp"
#include "waymark/models/camera.hpp"
#include "waymark/vision/search.hpp"

namespace waymark::vision {

struct TrackerOptions {
  int patch_px = 16;
  int most_observed = 30;  ///< landmarks looked for in one picture
};

void describe(Schema& schema, TrackerOptions& options);

/// What was found in a picture, and what was looked for in vain. Views into the tracker.
struct Sightings {
  std::span<const Observation> found;
  std::span<const LandmarkId> missed;
};

/// What became of one expectation or corner in the last picture, for those who want to draw it.
struct Look {
  enum class Result : std::uint8_t { kNotTried, kFound, kMissed, kNew };
  LandmarkId id;
  bool candidate = false;
  Result result = Result::kNotTried;
  Eigen::Vector2d predicted_px = Eigen::Vector2d::Zero();
  Eigen::Matrix2d S = Eigen::Matrix2d::Zero();
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();  ///< where it was found, or the best place
};

/// The camera front end: remembers what landmarks look like, looks for them where they are expected, and
/// proposes new corners where the picture has none. Per picture begin(), match(), finish(), learn().
class Tracker {
 public:
  /// Candidates and new corners are looked for on a thread of their own where `threads` > 1; the results are
  /// the same.
  Tracker(const TrackerOptions& options, const SearchOptions& search, const Camera& camera, int threads);

  /// Starts on a picture, taken at the expected pose; it must stay where it is until finish(). Expectations
  /// are copied.
  void begin(const ImageView& image, const Pose2& T_world_robot, std::span<const Expectation> expectations);
  /// The landmarks: those that tell most for their cost first, within the budget.
  [[nodiscard]] Sightings match();
  /// The candidates, and new corners under new identities.
  [[nodiscard]] Sightings finish();
  /// What the filter made of finish(): forgets what it did not take and what it dropped.
  void learn(const Correction& correction);

  [[nodiscard]] std::span<const Look> looks() const;
  [[nodiscard]] const FunctionBlocks& blocks() const { return blocks_; }

 private:
  FunctionBlocks blocks_{"FB2 corners", "FB4 match", "FB7 match candidates"};
};

}  // namespace waymark::vision
