#pragma once

#include <cmath>
#include <cstdint>
#include <deque>
#include <vector>

#include <Eigen/Core>

#include "waymark/core/aligned_array.hpp"
#include "waymark/core/pose2.hpp"
#include "waymark/core/random.hpp"
#include "waymark/kernels/particle_columns.hpp"
#include "waymark/kernels/particle_observations.hpp"
#include "waymark/kernels/particle_poses.hpp"

namespace waymark::test {

/// Columns of one length, padded; copied with all their values.
class Columns {
 public:
  explicit Columns(std::size_t count) : count_(kernels::round_up_particles(count)) {}

  float* add() { return columns_.emplace_back(count_).data(); }
  kernels::PoseColumns add_poses() { return {add(), add(), add(), add()}; }
  kernels::GaussianColumns add_gaussian() { return {add(), add(), add(), add(), add()}; }
  kernels::IncrementColumns add_increments() {
    return {add(), add(), add(), add(), add(), add(), add(), add(), add()};
  }

  [[nodiscard]] std::vector<std::vector<float>> values() const {
    std::vector<std::vector<float>> all;
    for (const auto& column : columns_) all.emplace_back(column.data(), column.data() + count_);
    return all;
  }
  void restore(const std::vector<std::vector<float>>& values) {
    for (std::size_t c = 0; c < columns_.size(); ++c)
      std::copy(values[c].begin(), values[c].end(), columns_[c].data());
  }

 private:
  std::size_t count_;
  std::deque<AlignedArray<float>> columns_;
};

inline Eigen::Matrix2d covariance_of(const kernels::GaussianColumns& m, std::size_t i) {
  return Eigen::Matrix2f{{m.aa[i], m.ab[i]}, {m.ab[i], m.bb[i]}}.cast<double>();
}

inline Eigen::Vector2d mean_of(const kernels::GaussianColumns& m, std::size_t i) {
  return Eigen::Vector2f(m.a[i], m.b[i]).cast<double>();
}

inline Eigen::Matrix3d covariance_of(const kernels::IncrementColumns& d, std::size_t i) {
  return Eigen::Matrix3f{
      {d.xx[i], d.xy[i], d.xt[i]}, {d.xy[i], d.yy[i], d.yt[i]}, {d.xt[i], d.yt[i], d.tt[i]}}
      .cast<double>();
}

inline Eigen::Vector3d mean_of(const kernels::IncrementColumns& d, std::size_t i) {
  return Eigen::Vector3f(d.x[i], d.y[i], d.t[i]).cast<double>();
}

inline Pose2 pose_of(const kernels::PoseColumns& p, std::size_t i) {
  return {p.x[i], p.y[i], std::atan2(p.sin[i], p.cos[i])};
}

/// A few particles, about a metre apart, that all know one landmark some metres ahead, each a little
/// differently.
class ParticleScene {
 public:
  ParticleScene(std::size_t count, kernels::LandmarkForm form, kernels::ObservationKind kind,
                std::size_t modes, std::uint64_t seed)
      : count_(count),
        columns_(count),
        log_weight_(kernels::round_up_particles(count)),
        random_(seed, StreamPurpose::kWorld) {
    for (std::size_t k = 0; k < modes; ++k)
      modes_.push_back({columns_.add_gaussian(), modes > 1 ? columns_.add() : nullptr});
    observation.landmark = {form, 0.3F, -0.2F, columns_.add(), columns_.add(), modes_.data(), modes};
    observation.mount = {0.4F, -0.3F, std::cos(0.5F), std::sin(0.5F), 0.6F, 0.02F};
    observation.seen = {kind, 5.0F, std::cos(0.4F), std::sin(0.4F), 0.01F, 0.0005F, 0.002F};
    for (std::size_t i = 0; i < kernels::round_up_particles(count); ++i) draw_particle(i);
  }

  [[nodiscard]] Columns& columns() { return columns_; }
  [[nodiscard]] double* log_weight() { return log_weight_.data(); }
  [[nodiscard]] kernels::ParticleRange range() const { return {0, count_}; }
  [[nodiscard]] std::size_t count() const { return count_; }
  [[nodiscard]] const kernels::GaussianColumns& gaussian(std::size_t mode = 0) const {
    return modes_[mode].gaussian;
  }
  [[nodiscard]] const std::vector<kernels::LandmarkMode>& modes() const { return modes_; }

 private:
  float normal(double sigma, double mean = 0.0) {
    return static_cast<float>(mean + sigma * random_.normal());
  }

  void draw_particle(std::size_t i) {
    const double theta = 0.1 * random_.normal();
    poses.x[i] = normal(0.2);
    poses.y[i] = normal(0.2);
    poses.cos[i] = static_cast<float>(std::cos(theta));
    poses.sin[i] = static_cast<float>(std::sin(theta));
    const auto& d = increments;
    d.x[i] = normal(0.05, 0.1);
    d.y[i] = normal(0.01);
    d.t[i] = normal(0.05);
    d.xx[i] = 2e-3F;
    d.xy[i] = 3e-4F;
    d.xt[i] = 2e-4F;
    d.yy[i] = 1e-3F;
    d.yt[i] = 4e-4F;
    d.tt[i] = 3e-3F;
    const auto& landmark = observation.landmark;
    landmark.anchor_x[i] = normal(0.3);
    landmark.anchor_y[i] = normal(0.3);
    const auto modes = static_cast<double>(modes_.size());
    for (std::size_t k = 0; k < modes_.size(); ++k) {
      const auto& m = modes_[k].gaussian;
      // As a point (a, b) is (x, y), as a ray (phi, rho), as a ring (phi, r).
      const bool is_point = landmark.form == kernels::LandmarkForm::kPoint;
      const bool is_ray = landmark.form == kernels::LandmarkForm::kRay;
      const double spread = 0.3 * (static_cast<double>(k) - 0.5 * (modes - 1.0));
      m.a[i] = is_point ? normal(0.2, 4.0) : normal(0.05, 0.4 + spread);
      m.b[i] = is_point ? normal(0.2, 2.0) : normal(0.02, is_ray ? 0.25 : 5.0);
      m.aa[i] = static_cast<float>(random_.uniform(0.01, 0.03));
      m.bb[i] = static_cast<float>(random_.uniform(0.01, 0.03)) * (is_ray ? 0.1F : 1.0F);
      m.ab[i] = static_cast<float>(0.5 * random_.uniform(-1.0, 1.0) * std::sqrt(m.aa[i] * m.bb[i]));
      if (modes > 1.0) modes_[k].log_weight[i] = static_cast<float>(-std::log(modes));
    }
  }

  std::size_t count_;
  Columns columns_;
  AlignedArray<double> log_weight_;
  std::vector<kernels::LandmarkMode> modes_;
  RandomStream random_;

 public:
  kernels::PoseColumns poses = columns_.add_poses();
  kernels::IncrementColumns increments = columns_.add_increments();
  kernels::LandmarkObservation observation;
};

}  // namespace waymark::test
