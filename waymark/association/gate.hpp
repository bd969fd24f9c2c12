#pragma once

#include <array>

namespace waymark {

struct GateOptions {
  double probability = 0.999999;  ///< part of the true observations that may pass
};

/// Chi-square thresholds on the NIS, looked up once: identities are gated like everything else, since a
/// reader misreads now and then.
class Gate {
 public:
  explicit Gate(const GateOptions& options);

  /// For `dof` of 1 to 3.
  [[nodiscard]] double threshold(int dof) const { return thresholds_[static_cast<std::size_t>(dof)]; }

 private:
  std::array<double, 4> thresholds_{};
};

}  // namespace waymark
