#include "waymark/vision/match_order.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace waymark::vision {
namespace {

double sortable(double x) { return std::isnan(x) ? -std::numeric_limits<double>::infinity() : x; }

}  // namespace

void order_by_usefulness(std::span<Prospect> prospects) {
  std::ranges::sort(prospects, [](const Prospect& a, const Prospect& b) {
    return std::pair(-sortable(a.usefulness()), a.expectation) <
           std::pair(-sortable(b.usefulness()), b.expectation);
  });
}

}  // namespace waymark::vision
