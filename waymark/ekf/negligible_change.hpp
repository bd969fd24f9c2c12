#pragma once

namespace waymark::ekf {

/// What the innovations after an update may differ from what was linearly expected of them, squared and in
/// units of the noise: a fifth of its standard deviation.
inline constexpr double kNegligibleChange = 0.04;

}  // namespace waymark::ekf
