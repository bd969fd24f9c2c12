#include "waymark/association/gate.hpp"

#include "waymark/core/chi2.hpp"

namespace waymark {

Gate::Gate(const GateOptions& options) {
  for (int dof = 1; dof <= 3; ++dof)
    thresholds_[static_cast<std::size_t>(dof)] = chi2_quantile(options.probability, dof);
}

}  // namespace waymark
