#include "waymark/fastslam/information_weight.hpp"

#include <algorithm>
#include <cmath>

namespace waymark::fastslam {

double InformationWeight::power(double way_since_m) const {
  return evidence_way_m_ > 0.0 ? -std::expm1(-way_since_m / evidence_way_m_) : 1.0;
}

double lasting_variance_factor(double way_since_m, double lasting_way_m) {
  return 1.0 / std::tanh(std::max(way_since_m, kLeastWay_m) / (2.0 * lasting_way_m));
}

}  // namespace waymark::fastslam
