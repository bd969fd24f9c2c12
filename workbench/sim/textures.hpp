#pragma once

#include "waymark/core/random.hpp"

#include "workbench/sim/canvas.hpp"

namespace waymark::sim {

/// The side of a texel of every painted surface.
inline constexpr double kTexel_m = 0.005;

/// Surfaces of a building, no two alike: what is drawn decides them. A wall is plaster and brick with
/// posters, 2.56 m high, and repeats after 20.48 m; floor and ceiling after 5.12 m, furniture and clothes
/// after 1.28 m.
[[nodiscard]] Canvas paint_wall(double length_m, RandomStream& random);
[[nodiscard]] Canvas paint_floor(RandomStream& random);
[[nodiscard]] Canvas paint_ceiling(RandomStream& random);
[[nodiscard]] Canvas paint_furniture(RandomStream& random);
[[nodiscard]] Canvas paint_clothes(RandomStream& random);

}  // namespace waymark::sim
