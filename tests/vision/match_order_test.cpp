#include "waymark/vision/match_order.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "waymark/core/random.hpp"

namespace waymark::vision {
namespace {

TEST(MatchOrder, PutsWhatTellsMostForItsCostFirst) {
  RandomStream random(1, StreamPurpose::kWorld);
  std::vector<Prospect> prospects;
  for (std::size_t k = 0; k < 200; ++k)
    prospects.push_back({k, random.uniform(0.0, 5.0), random.uniform(100.0, 1e5)});
  order_by_usefulness(prospects);
  for (std::size_t k = 1; k < prospects.size(); ++k)
    EXPECT_GE(prospects[k - 1].nats / prospects[k - 1].cost_ns, prospects[k].nats / prospects[k].cost_ns);
}

TEST(MatchOrder, LeavesEqualsInTheirOrderAndWhatIsNoNumberBehind) {
  std::vector<Prospect> prospects{{0, std::nan(""), 1.0}, {1, 2.0, 1.0}, {2, -1.0, 1.0}, {3, 4.0, 2.0}};
  order_by_usefulness(prospects);
  std::vector<std::size_t> order;
  for (const Prospect& p : prospects) order.push_back(p.expectation);
  EXPECT_EQ(order, (std::vector<std::size_t>{1, 3, 2, 0}));
}

}  // namespace
}  // namespace waymark::vision
