#pragma once

#include <cstddef>
#include <cstdint>

#include "waymark/kernels/particle_columns.hpp"

namespace waymark::kernels {

/// World poses of particles in double precision, `count` of them; arrays are padded as columns are.
struct WorldPoses {
  const double* x_m = nullptr;
  const double* y_m = nullptr;
  const double* theta_rad = nullptr;
};

/// The same, to be moved.
struct MovingPoses {
  double* x_m = nullptr;
  double* y_m = nullptr;
  double* theta_rad = nullptr;
};

/// Poses as columns, positions from the origin (origin_x, origin_y).
void load_poses(const WorldPoses& world, double origin_x, double origin_y, const PoseColumns& poses,
                std::size_t count);

/// Robot poses to where their sensors are; the headings stay the robots'. In place if the columns are the
/// same.
void place_sensors(const PoseColumns& robots, const SensorMount& mount, const PoseColumns& sensors,
                   std::size_t count);

/// The same increment for all.
void fill_increments(const Increment& increment, const IncrementColumns& increments, std::size_t count);

/// Which random numbers to draw: those of the stream (seed, purpose, step), particle by particle from
/// `first`.
struct DrawKey {
  std::uint64_t seed = 0;
  std::uint32_t purpose = 0;
  std::uint64_t step = 0;
  std::uint32_t first = 0;
};

/// Three standard normals per particle, by Philox4x32-10 and Box and Muller: numbers of particle i depend on
/// the key and i alone. Tails end at 6.6 sigma.
void draw_normals(const DrawKey& key, float* n0, float* n1, float* n2, std::size_t count);

/// Moves each robot by a draw mu + L n from its increment, P = L L^T of any rank: the world poses and the
/// columns.
void draw_poses(const IncrementColumns& increments, const float* n0, const float* n1, const float* n2,
                const PoseColumns& robots, const MovingPoses& world, std::size_t count);

namespace reference {
void load_poses(const WorldPoses& world, double origin_x, double origin_y, const PoseColumns& poses,
                std::size_t count);
void draw_poses(const IncrementColumns& increments, const float* n0, const float* n1, const float* n2,
                const PoseColumns& robots, const MovingPoses& world, std::size_t count);
}  // namespace reference
}  // namespace waymark::kernels
