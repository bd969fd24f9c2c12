#pragma once

#include <array>

namespace waymark {

struct GateOptions {
  double probability = 0.999999;  ///< part of the true observations that may pass
};

/// Chi-square thresholds for the NIS, computed once. Observations of known identity are gated, too,
/// because a sensor may misread identities.
class Gate {
 public:
  explicit Gate(const GateOptions& options);

  /// For `dof` of 1 to 3.
  [[nodiscard]] double threshold(int dof) const { return thresholds_[static_cast<std::size_t>(dof)]; }

 private:
  std::array<double, 4> thresholds_{};
};

}  // namespace waymark
