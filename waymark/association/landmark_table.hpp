#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "waymark/association/existence.hpp"
#include "waymark/association/id_index.hpp"
#include "waymark/core/as_index.hpp"
#include "waymark/core/observation.hpp"

namespace waymark {

/// What the id of a landmark says.
enum class Identity : std::uint8_t {
  kKnown,      ///< which landmark it is: observations name it
  kUnknown,    ///< a number of the filter's own, for a landmark that was met without identity
  kNoLandmark  ///< a point that a filter keeps beside its landmarks; never in the map
};

/// What a filter knows of a landmark besides where it is.
struct LandmarkRecord {
  LandmarkId id = {};
  Identity identity = Identity::kKnown;
  Existence existence = Existence::certain();
  int observations = 1;
  double observed_at_m = 0.0;  ///< distance travelled when it was last observed
  std::int64_t added_at_scan = 0;
  std::int64_t observed_at_scan = 0;
  std::int64_t claimed_at_scan = 0;  ///< the last scan that had an observation for it, gated ones too
};

/// The records of a filter's landmarks, in the order in which they stand in its state: append() and remove()
/// go with those of the state. Keeps count of scans and of the distance travelled, so that each record knows
/// how long ago its landmark was seen. All memory is taken at construction but for the index by identity,
/// which takes a little for each landmark that observations name.
class LandmarkTable {
 public:
  explicit LandmarkTable(int capacity);

  /// The robot moves on, by a distance as travelled_m() measures it, turns included.
  void travel(double distance_m) { travelled_m_ += distance_m; }
  /// Scans count from 1; what came before, such as a loaded map, is of scan 0.
  void begin_scan();
  [[nodiscard]] double travelled_m() const { return travelled_m_; }
  [[nodiscard]] std::int64_t scan() const { return scan_; }

  [[nodiscard]] int size() const { return static_cast<int>(records_.size()); }
  [[nodiscard]] const LandmarkRecord& operator[](int landmark) const { return records_[as_index(landmark)]; }
  /// The landmark that observations name so.
  [[nodiscard]] std::optional<int> find(LandmarkId id) const { return index_.find(id); }
  /// An id for a landmark without identity that no record has had.
  [[nodiscard]] LandmarkId unused_id() const { return {LandmarkId::Family::kNone, next_number_}; }

  /// Appends a landmark as observed and claimed in the present scan.
  void append(const LandmarkRecord& record);
  /// The last record takes its place. O(1).
  void remove(int landmark);
  /// Landmarks of the map that were removed since the scan began.
  [[nodiscard]] std::span<const LandmarkId> removed() const { return removed_; }

  /// An observation of the present scan is held to be of this landmark.
  void claim(int landmark) { records_[as_index(landmark)].claimed_at_scan = scan_; }
  /// An observation of the present scan was used.
  void observe(int landmark);
  /// The observations of `twin` were of `landmark`; `twin` is still to be removed.
  void absorb(int landmark, int twin);
  [[nodiscard]] Existence& existence(int landmark) { return records_[as_index(landmark)].existence; }

  [[nodiscard]] bool is_claimed(int landmark) const { return (*this)[landmark].claimed_at_scan == scan_; }
  [[nodiscard]] bool is_observed(int landmark) const { return (*this)[landmark].observed_at_scan == scan_; }
  /// Distance travelled since it was last observed.
  [[nodiscard]] double travelled_since_m(int landmark) const {
    return travelled_m_ - (*this)[landmark].observed_at_m;
  }
  /// Whether a landmark that is connected was observed after this one was added; those of the first scan that
  /// adds any are. What a robot adds that has lost its place is not connected with what it knew before.
  [[nodiscard]] bool is_connected(int landmark) const {
    return (*this)[landmark].added_at_scan < connected_until_scan_;
  }
  /// Tentative landmarks are not.
  [[nodiscard]] bool is_in_map(int landmark) const;
  /// Whether it was never confirmed and the robot has gone too far (kTentativeDistance_m) since it was last
  /// seen.
  [[nodiscard]] bool is_stale(int landmark) const;

 private:
  IdIndex index_;  // of those with a known identity
  std::vector<LandmarkRecord> records_;
  std::vector<LandmarkId> removed_;
  std::int32_t next_number_ = 0;
  std::int64_t scan_ = 0;
  std::int64_t connected_until_scan_ = 0;  // landmarks that were added before it are connected
  double travelled_m_ = 0.0;
};

}  // namespace waymark
