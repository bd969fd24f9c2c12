#pragma once

#include <cstddef>
#include <span>

namespace waymark::vision {

/// Something that could be searched for.
struct Prospect {
  std::size_t expectation = 0;  ///< which one
  double nats = 0.0;            ///< what an observation would tell
  double cost_ns = 1.0;         ///< what searching for it takes

  [[nodiscard]] double usefulness() const { return nats / cost_ns; }
};

/// The most information for its cost first (Davison 2005); equals, and what is no number at last, in the
/// order of expectations.
void order_by_usefulness(std::span<Prospect> prospects);

}  // namespace waymark::vision
