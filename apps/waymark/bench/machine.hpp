#pragma once

#include <string>

namespace waymark::app {

/// What the figures were taken on.
struct Machine {
  std::string cpu;
  unsigned cores = 0;
  std::string instruction_set;
  double fma_gflops = 0.0;  ///< one core, double: measured multiply-add peak
};

[[nodiscard]] Machine inspect_machine();

}  // namespace waymark::app
