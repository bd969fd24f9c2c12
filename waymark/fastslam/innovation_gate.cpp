#include "waymark/fastslam/innovation_gate.hpp"

#include "waymark/core/gaussian.hpp"

namespace waymark::fastslam {

void InnovationGate::judge(std::size_t index, Scan& scan, Belief& belief) const {
  const int landmark = scan.landmarks[index];
  const Observation& observation = scan.observations[index];
  belief.store.gather(landmark);
  scan.moments[index] = compare(observation, landmark, belief);
  const Eigen::Vector2d& nu = scan.moments[index].mean;
  const Eigen::Matrix2d S = scan.moments[index].covariance();
  const int dof = dimension(*kind_of(observation.value));
  const auto nis = dof == 2 ? mahalanobis_squared<2>(nu, S)
                            : mahalanobis_squared<1>(nu.head<1>(), S.topLeftCorner<1, 1>());
  Innovation& innovation = scan.innovations[index];
  if (nis && innovation.dof == 0) {
    innovation.log_density =
        dof == 2 ? log_gaussian<2>(*nis, S) : log_gaussian<1>(*nis, S.topLeftCorner<1, 1>());
    innovation.standardised.head(dof) = nu.head(dof).cwiseQuotient(S.diagonal().head(dof).cwiseSqrt());
  }
  innovation.dof = nis ? dof : 0;
  innovation.nis = nis.value_or(0.0);
  innovation.gate = gate_.threshold(dof);
  innovation.outcome = !nis                     ? Outcome::kUnusable
                       : *nis > innovation.gate ? Outcome::kGated
                                                : Outcome::kMatched;
}

}  // namespace waymark::fastslam
