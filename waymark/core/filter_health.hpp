#pragma once

namespace waymark {

/// What a filter has found out about its landmarks and its robot so far. All zero where nothing went wrong,
/// and for a filter that does not look.
struct FilterHealth {
  int false_firsts = 0;  ///< landmarks that began anew because their only observation was false
  int carried = 0;       ///< landmarks that were found elsewhere
  int distrusted = 0;    ///< of these, found elsewhere again: no longer used
  int slips = 0;         ///< how often its pose was widened because it seems to have slipped
  int recoveries = 0;    ///< how often the robot was lost and found
  bool lost = false;     ///< the robot is lost now
};

}  // namespace waymark
