#pragma once

#include <array>
#include <cstdint>

#include "waymark/core/grey_image.hpp"
#include "waymark/core/parallel.hpp"
#include "waymark/core/random.hpp"
#include "waymark/models/camera.hpp"

#include "workbench/sim/drive.hpp"
#include "workbench/sim/options.hpp"
#include "workbench/sim/renderer.hpp"
#include "workbench/sim/scene.hpp"

namespace waymark::sim {

/// A vibration: four sines of 4 to 12 Hz.
class Vibration {
 public:
  explicit Vibration(RandomStream random);
  /// Mean 0 and standard deviation 1 over time.
  [[nodiscard]] double at(double time_s) const;

 private:
  std::array<double, 4> frequency_hz_{};
  std::array<double, 4> phase_rad_{};
};

/// What a camera on a driving robot takes of a scene, image by image: each depends on its number alone, not
/// on those taken before.
class CameraSimulator {
 public:
  /// What is said about the scene, the drive and the camera is the options'; errors are drawn by the seed.
  CameraSimulator(const CameraSimulatorOptions& options, Scene scene, Drive drive, std::uint64_t seed,
                  int threads);

  /// Images are taken while the robot drives.
  [[nodiscard]] std::size_t size() const;
  /// The middle of the exposure.
  [[nodiscard]] Stamp stamp(std::size_t image) const;
  [[nodiscard]] std::size_t number(Stamp stamp) const;
  /// Does it get lost on its way?
  [[nodiscard]] bool is_lost(std::size_t image) const;
  /// Some 2 ms for 320 x 240 pixels.
  [[nodiscard]] GreyImage take(std::size_t image);

  /// Where the camera really is, vibration included.
  [[nodiscard]] Viewpoint viewpoint(Stamp when) const;
  /// Factor on the grey of an image: what the light and the camera's own exposure make of it.
  [[nodiscard]] double brightness(Stamp when) const;

 private:
  [[nodiscard]] int moments(Stamp when) const;

  CameraSimulatorOptions options_;
  Scene scene_;
  Drive drive_;
  std::uint64_t seed_;
  Camera camera_;
  ThreadPool pool_;
  Renderer renderer_;
  Vibration pitch_, roll_, height_;
  double drift_phase_rad_;
};

}  // namespace waymark::sim
