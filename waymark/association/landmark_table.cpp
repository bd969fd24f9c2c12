#include "waymark/association/landmark_table.hpp"

#include <algorithm>

namespace waymark {

LandmarkTable::LandmarkTable(int capacity) : index_(as_index(capacity)) {
  records_.reserve(as_index(capacity));
  removed_.reserve(as_index(capacity));
}

void LandmarkTable::begin_scan() {
  ++scan_;
  removed_.clear();
}

void LandmarkTable::append(const LandmarkRecord& record) {
  if (record.identity == Identity::kKnown) index_.assign(record.id, size());
  if (record.identity != Identity::kNoLandmark && record.id.family == LandmarkId::Family::kNone)
    next_number_ = std::max(next_number_, record.id.number + 1);
  LandmarkRecord& appended = records_.emplace_back(record);
  appended.observed_at_m = travelled_m_;
  appended.added_at_scan = appended.observed_at_scan = appended.claimed_at_scan = scan_;
  if (size() == 1) connected_until_scan_ = scan_ + 1;
}

void LandmarkTable::remove(int landmark) {
  const LandmarkRecord& gone = (*this)[landmark];
  const LandmarkRecord& last = records_.back();
  if (is_in_map(landmark)) removed_.push_back(gone.id);
  if (last.identity == Identity::kKnown) index_.assign(last.id, landmark);
  if (gone.identity == Identity::kKnown) index_.erase(gone.id);
  records_[as_index(landmark)] = last;
  records_.pop_back();
}

void LandmarkTable::observe(int landmark) {
  if (is_connected(landmark)) connected_until_scan_ = std::max(connected_until_scan_, scan_);
  LandmarkRecord& observed = records_[as_index(landmark)];
  ++observed.observations;
  observed.observed_at_m = travelled_m_;
  observed.observed_at_scan = scan_;
}

void LandmarkTable::absorb(int landmark, int twin) {
  observe(landmark);
  records_[as_index(landmark)].observations += (*this)[twin].observations - 1;
}

bool LandmarkTable::is_in_map(int landmark) const {
  const LandmarkRecord& record = (*this)[landmark];
  return record.identity != Identity::kNoLandmark && record.existence.is_confirmed();
}

bool LandmarkTable::is_stale(int landmark) const {
  return !(*this)[landmark].existence.is_confirmed() && travelled_since_m(landmark) > kTentativeDistance_m;
}

}  // namespace waymark
