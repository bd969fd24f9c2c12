#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "waymark/association/landmark_table.hpp"
#include "waymark/core/motion.hpp"
#include "waymark/fastslam/fast_slam_options.hpp"
#include "waymark/fastslam/gate_sample.hpp"
#include "waymark/fastslam/landmark_store.hpp"
#include "waymark/fastslam/particle_blocks.hpp"
#include "waymark/fastslam/particle_step.hpp"
#include "waymark/fastslam/particles.hpp"
#include "waymark/fastslam/range_calibration.hpp"
#include "waymark/models/landmark_sensor.hpp"

namespace waymark::fastslam {

/// What the set knows of a landmark besides its record in the table.
struct ParticleRecord {
  double existence_probability = 1.0;  ///< 0: it is to be removed
  double range_alone_m = 0.0;          ///< when it was last observed; 0 if more than that was measured
};

/// What is believed of robot and landmarks: the particles with the map of each, the motion that they have
/// still to make, and the estimate.
struct Belief {
  /// As options and sensor say that it begins. `threads` share the particles. Takes memory for the particles
  /// here, and for a landmark when it is added.
  Belief(const FastSlamOptions& options, const LandmarkSensor& sensor, int threads);

  ParticleBlocks blocks;
  Particles particles;
  RangeCalibration calibration;
  LandmarkStore store;                  ///< landmarks as each particle knows them
  LandmarkTable landmarks;              ///< what all particles know alike of them
  std::vector<ParticleRecord> records;  ///< the same, what the table has no place for
  GateSample sample;                    ///< of the particles, for compare()
  PoseEstimate estimate;                ///< of the robot, after weighting and before resampling
  Motion pending;                       ///< since the particles last moved
  bool has_moved = false;               ///< since the set was last asked whether it wants resampling
  std::uint64_t seed;
  std::uint64_t steps = 0;  ///< made by the particles: which random numbers the next one draws

  /// The pending motion grows by one that is neither still nor without numbers. O(1).
  void predict(const Motion& motion);

  /// The particles make the pending motion, and take in the observations. O(N (1 + observations)).
  void step(std::span<const AcceptedObservation> accepted);

  /// The estimate follows the particles' weights. O(N).
  void update_estimate();

  /// Particle i becomes a copy of ancestors[i], its map included. See LandmarkStore::resample() for the cost.
  void resample(std::span<const std::int32_t> ancestors);

  /// Appends a landmark to store, table and records, and returns its index. Its columns in the store hold
  /// anything; one without identity has log-odds of its existence among them.
  int add(const LandmarkRecord& record, kernels::LandmarkForm form, std::size_t modes,
          const Observation& first);
  /// Forgets a landmark; the last one takes its index.
  void remove(int landmark);
  /// The scan observed the landmark so.
  void observe(int landmark, const Observation& observation);

  /// The estimate, moved by the pending motion.
  [[nodiscard]] PoseEstimate pose() const;

  /// From where kernels count positions.
  [[nodiscard]] Eigen::Vector2d origin_m() const { return estimate.T_world_robot.position(); }
  /// A gathered landmark, as kernels see it. Valid as LandmarkStore::view() is.
  [[nodiscard]] kernels::LandmarkView view(int landmark) const { return store.view(landmark, origin_m()); }

  /// Takes a sample of the particles as they are now, for compare().
  void load_sample() { sample.load(particles, origin_m()); }
  /// How an observation compares with what the set expects after the pending motion. The particles must not
  /// have changed since load_sample().
  [[nodiscard]] InnovationMoments compare(const kernels::LandmarkObservation& landmark_observation) {
    return sample.compare(landmark_observation, increment_of(pending));
  }

  /// Calls job(sensors, range) for every block of particles, `sensors` being where they have the sensor. On
  /// several threads.
  template <class Job>
  void run_with_sensors(const kernels::SensorMount& mount, const Job& job) {
    blocks.run([&, origin_m = origin_m()](std::size_t begin, std::size_t end) {
      BlockScratch scratch;
      const kernels::ParticleRange range{begin, end - begin};
      job(load_sensors(particles, mount, origin_m, range, scratch), range);
    });
  }
};

}  // namespace waymark::fastslam
