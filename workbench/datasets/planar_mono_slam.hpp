#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>

#include "waymark/core/result.hpp"

#include "workbench/logs/source.hpp"

namespace waymark {

/// Noise that is added to points that were recorded without any.
struct PixelNoise {
  double sigma_px = 1.0;
  std::uint64_t seed = 1;
};

/// Does the folder hold camera.dat, trajectory.dat and world.dat?
[[nodiscard]] bool is_planar_mono_slam(const std::filesystem::path& folder);

/// Opens the exercise data set of the Probabilistic Robotics course in Rome (Grisetti, Sapienza): a simulated
/// robot on a plane with one camera. OdometryPose, Truth, and per step one Observations of pixels with the
/// true identities, to which noise is added; camera with its mount, landmarks of the survey with heights. The
/// files have no time: a step of about 0.2 m is taken for 0.2 s. The settings are those of
/// configs/planar-mono-slam.yaml. All of it is read at once; errors name file and line.
[[nodiscard]] Result<std::unique_ptr<Source>> open_planar_mono_slam(const std::filesystem::path& folder,
                                                                    const PixelNoise& noise);

}  // namespace waymark
