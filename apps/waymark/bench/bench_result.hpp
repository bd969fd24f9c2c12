#pragma once

#include <functional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace waymark::app {

/// One measured figure: a median of several rounds.
struct BenchResult {
  std::string name;               ///< "ekf.step"
  nlohmann::ordered_json params;  ///< what it depends on: {"landmarks": 200, ...}
  double value = 0.0;
  std::string unit;
};

/// How much to measure.
enum class BenchScope {
  kFull,
  kQuick,  ///< the same figures of smaller maps in fewer rounds: in a second, and rougher
};

/// Told the part of the work that is done.
using BenchProgress = std::function<void(double fraction)>;

}  // namespace waymark::app
