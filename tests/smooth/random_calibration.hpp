#pragma once

#include "waymark/core/random.hpp"
#include "waymark/core/sensor_bias.hpp"

namespace waymark::test {

/// Every key off by up to a tenth.
inline Calibration random_calibration(RandomStream& random) {
  Calibration c;
  for (auto& entry : c) entry = random.uniform(-0.1, 0.1);
  return c;
}

}  // namespace waymark::test
