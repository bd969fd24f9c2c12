#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "waymark/core/background.hpp"
#include "waymark/core/expectation.hpp"
#include "waymark/core/filter.hpp"
#include "waymark/core/function_blocks.hpp"
#include "waymark/core/grey_image.hpp"
#include "waymark/core/stopwatch.hpp"
#include "waymark/models/camera.hpp"
#include "waymark/vision/frame_budget.hpp"
#include "waymark/vision/landmark_finder.hpp"
#include "waymark/vision/match_order.hpp"
#include "waymark/vision/new_corners.hpp"
#include "waymark/vision/search.hpp"
#include "waymark/vision/search_record.hpp"
#include "waymark/vision/tracker_counts.hpp"
#include "waymark/vision/tracker_options.hpp"
#include "waymark/vision/visual_memory.hpp"

namespace waymark::vision {

/// What was found in an image, and what was searched for in vain. Views into the tracker.
struct SearchOutcome {
  std::span<const Observation> found;
  std::span<const LandmarkId> missed;
};

/// What is searched for at a time: new corners and candidates at the pose that the landmarks have corrected.
enum class Round { kLandmarks, kCandidates };

/// The camera front end: remembers what landmarks look like, searches for them where they are expected, and
/// proposes new corners where the image has none. Per image one call of track().
///
/// An image that shows nothing (is_usable()) has no observations, and nothing counts as missed in it. Without
/// new landmarks nothing is allocated from the first image on, nor with them up to VisualMemory::kRoom.
class Tracker {
 public:
  /// Candidates and new corners are searched for on a thread of their own where `threads` > 1; the results
  /// are the same. Half a ms.
  Tracker(const TrackerOptions& options, const SearchOptions& search, const Camera& camera, int threads);

  /// Looks into an image, taken at the expected pose: for the landmarks, those that tell most for their cost
  /// first, within the budget; then for the candidates, and for new corners under new identities. Both times
  /// correct(round, observations) says what the filter made of it, as a Correction; what it dropped, and what
  /// it did not take of the second round, is forgotten. Observations are valid during that call only.
  ///
  /// A new corner is the pixel around which its patch is cut, so its own place is certain by definition; it
  /// claims kMinPixelSigma, for what later matches against this patch have in common.
  template <class Correct>
  void track(const ImageView& image, const Pose2& T_world_robot, std::span<const Expectation> expectations,
             const Correct& correct) {
    begin(image, T_world_robot, expectations);
    learn(correct(Round::kLandmarks, match()));
    learn(correct(Round::kCandidates, finish()));
  }

  /// What landmarks and candidates look like. Allocates.
  [[nodiscard]] std::vector<LandmarkPatch> patches() const { return memory_.patches(); }
  /// Knows from now on what these look like; ReferencePatch::kSide squared pixels each, others are passed
  /// over.
  void remember(std::span<const LandmarkPatch> patches);

  /// How much of the frame's budget others need.
  void leave_time(Duration others) { others_ = others; }

  /// Every expectation in its order, then the new corners, of the last image.
  [[nodiscard]] std::span<const SearchRecord> search_records() const { return search_records_; }
  [[nodiscard]] const TrackerCounts& counts() const { return counts_; }
  [[nodiscard]] const FunctionBlocks& blocks() const { return blocks_; }

 private:
  /// One who looks: for landmarks on the caller's thread, for candidates on the other.
  struct SearchWorker {
    SearchWorker(const TrackerOptions& options, const SearchOptions& search, const Camera& camera);
    LandmarkFinder finder;
    FrameBudget budget;
    std::vector<Prospect> prospects;
    std::vector<Observation> found;
    std::vector<LandmarkId> missed;
    bool is_out_of_budget = false;

    [[nodiscard]] SearchOutcome outcome() const { return {found, missed}; }
  };

  void begin(const ImageView& image, const Pose2& T_world_robot, std::span<const Expectation> expectations);
  [[nodiscard]] SearchOutcome match();
  [[nodiscard]] SearchOutcome finish();
  void learn(const Correction& correction);
  void copy(std::span<const Expectation> expectations);
  void avoid(LandmarkId id);
  void search_in_background();
  void save_up();
  void search_for(bool candidates, int most, SearchWorker& worker);
  void gather(bool candidates, SearchWorker& worker);
  void add_new_corners();
  [[nodiscard]] Duration background_budget() const;
  [[nodiscard]] Duration background_share() const;

  TrackerOptions options_;
  double grey_sigma_;
  Camera camera_;
  VisualMemory memory_;
  NewCorners new_corners_;
  SearchWorker landmarks_, candidates_;
  Duration others_{0};
  Duration background_budget_{0};  ///< budget of the other thread for this image
  Duration saved_{0};              ///< of those before, for what was too dear for one of them

  // Of the present image.
  ImageView image_;
  CameraPose here_;
  bool is_usable_ = false;
  std::vector<Expectation> expectations_;
  std::vector<Appearance*> appearances_;  ///< of each; null where it is not known
  std::vector<Eigen::Matrix2d> R_;        ///< of each that was found
  std::vector<SearchRecord> search_records_;
  std::vector<Eigen::Vector2d> features_;  ///< predicted places of those that can be searched for
  int candidates_under_way_ = 0;
  std::span<const Corner> corners_;
  Pose2 T_world_robot_;
  std::vector<LandmarkId> proposed_;  ///< new corners of which learn() has not heard yet
  std::int32_t next_number_ = 0;

  TrackerCounts counts_;
  Stopwatch background_stopwatch_;  ///< of whichever thread search_in_background() runs on
  Duration corners_took_{0}, candidates_took_{0};
  FunctionBlocks blocks_{"FB2 corners", "FB4 match", "FB7 match candidates"};  // Vincke Table 1
  Background background_;  ///< last, so that its thread ends before what it works on
};

}  // namespace waymark::vision
