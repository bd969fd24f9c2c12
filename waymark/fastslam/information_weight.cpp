#include "waymark/fastslam/information_weight.hpp"

#include <cmath>

namespace waymark::fastslam {

double InformationWeight::power(double travelled_since_m) const {
  return information_distance_m_ > 0.0 ? -std::expm1(-travelled_since_m / information_distance_m_) : 1.0;
}

}  // namespace waymark::fastslam
