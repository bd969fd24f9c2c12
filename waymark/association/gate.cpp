#include "waymark/association/gate.hpp"

#include "waymark/core/chi2.hpp"

namespace waymark {

void describe(Schema& schema, GateOptions& options) {
  schema.real("gate.probability", options.probability, {0.5, 1.0},
              "part of the true sightings that may pass the gate; 1 lets all pass");
}

Gate::Gate(const GateOptions& options) {
  for (int dof = 1; dof <= 3; ++dof)
    thresholds_[static_cast<std::size_t>(dof)] = chi2_quantile(options.probability, dof);
}

}  // namespace waymark
