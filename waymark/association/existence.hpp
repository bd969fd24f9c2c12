#pragma once

#include <limits>

#include "waymark/association/association_options.hpp"

namespace waymark {

/// How sure it is that a landmark is there: log-odds, see AssociationModel. A landmark that was met without
/// identity is tentative until it has been observed again often enough, and a false track when it was missed
/// too often.
class Existence {
 public:
  /// Tentative: as likely as not.
  Existence() = default;
  /// Of a landmark that is there whatever is observed.
  [[nodiscard]] static Existence certain() {
    Existence existence;
    existence.log_odds_ = std::numeric_limits<double>::infinity();
    existence.confirmed_ = true;
    return existence;
  }

  void see(const AssociationModel& model) {
    if (is_certain()) return;
    log_odds_ = model.after_observation(log_odds_);
    confirmed_ = confirmed_ || log_odds_ >= kConfirmedLogOdds;
  }
  void miss(const AssociationModel& model) { log_odds_ += model.missed(); }
  /// For filters that count otherwise.
  void confirm() { confirmed_ = true; }

  [[nodiscard]] double log_odds() const { return log_odds_; }
  [[nodiscard]] bool is_certain() const { return log_odds_ == std::numeric_limits<double>::infinity(); }
  [[nodiscard]] bool is_confirmed() const { return confirmed_; }
  [[nodiscard]] bool is_false_track() const { return log_odds_ < 0.0; }
  [[nodiscard]] double probability() const;

 private:
  double log_odds_ = 0.0;
  bool confirmed_ = false;
};

}  // namespace waymark
