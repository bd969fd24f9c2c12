#pragma once

#include "waymark/association/association_options.hpp"

namespace waymark {

/// How sure it is that a landmark is there which was met without a name: log-odds, see AssociationModel. It
/// is tentative until it has been seen again often enough, and a ghost when it was missed too often.
class Existence {
 public:
  void see(const AssociationModel& model) {
    log_odds_ = model.after_sighting(log_odds_);
    confirmed_ = confirmed_ || log_odds_ >= model.confirmed();
  }
  void miss(const AssociationModel& model) { log_odds_ += model.missed(); }

  [[nodiscard]] double log_odds() const { return log_odds_; }
  [[nodiscard]] bool is_confirmed() const { return confirmed_; }
  [[nodiscard]] bool is_ghost() const { return log_odds_ < 0.0; }
  [[nodiscard]] double probability() const;

 private:
  double log_odds_ = 0.0;
  bool confirmed_ = false;
};

}  // namespace waymark
