#include "waymark/association/existence.hpp"

#include <cmath>

namespace waymark {

double Existence::probability() const { return 1.0 / (1.0 + std::exp(-log_odds_)); }

}  // namespace waymark
