#include "waymark/fastslam/information_weight.hpp"

#include <algorithm>
#include <cmath>

namespace waymark::fastslam {

double InformationWeight::power(double travelled_since_m) const {
  return information_distance_m_ > 0.0 ? -std::expm1(-travelled_since_m / information_distance_m_) : 1.0;
}

double bias_variance_factor(double travelled_since_m, double bias_distance_m) {
  return 1.0 / std::tanh(std::max(travelled_since_m, kMinTravelled_m) / (2.0 * bias_distance_m));
}

}  // namespace waymark::fastslam
