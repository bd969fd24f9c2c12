#pragma once

#include <cstdint>

#include "workbench/sim/options.hpp"
#include "workbench/sim/path.hpp"
#include "workbench/sim/scene.hpp"

namespace waymark::sim {

/// The hull that encloses the path with the options' margin, and a corridor's core as far inside of it.
[[nodiscard]] Walls hull_around(const RoomOptions& options, const Path& path);
[[nodiscard]] Walls core_inside(const RoomOptions& options, const Path& path);

/// Hull, furniture at random places beside the path, people who walk where none stands, and markers on the
/// walls. The options must
/// name a scene. Some 0.1 s per 10 m of wall.
[[nodiscard]] Scene build_scene(const RoomOptions& options, const Path& path, std::uint64_t seed);

}  // namespace waymark::sim
