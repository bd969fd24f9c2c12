#pragma once

namespace waymark::fastslam {

/// Particles and their landmarks are kept as float.
[[nodiscard]] constexpr float narrow(double value) { return static_cast<float>(value); }

}  // namespace waymark::fastslam
