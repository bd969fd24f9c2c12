#include "workshop/figures/hand_held.hpp"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

namespace waymark {
namespace {

using Vector6d = Eigen::Matrix<double, 6, 1>;

constexpr double kStep = 1e-6;  // of numeric derivatives, rad and m

/// What is left of all observations, stacked; nothing where a point is behind the camera.
std::optional<Eigen::VectorXd> misfit(const WideAngleLens& lens, const HandHeld& place,
                                      std::span<const KnownObservation> observations) {
  Eigen::VectorXd r(2 * std::ssize(observations));
  for (Eigen::Index row = 0; const KnownObservation& each : observations) {
    const auto pixel = lens.pixel(place.to_camera(each.p_world));
    if (!pixel) return std::nullopt;
    r.segment<2>(row) = each.pixel - *pixel;
    row += 2;
  }
  return r;
}

/// The normal equations of a bundle: six numbers a camera but the first, one a ray.
class Bundle {
 public:
  Bundle(WideAngleLens lens, std::span<HandHeld> cameras, std::span<const KnownTrack> known,
         std::span<RayTrack> tracks)
      : lens_(std::move(lens)), cameras_(cameras), known_(known), tracks_(tracks) {}

  /// Cost and, where asked for, information matrix and gradient at the present estimate.
  double linearize(bool with_derivatives) {
    const auto size = static_cast<Eigen::Index>(6 * (cameras_.size() - 1) + tracks_.size());
    if (with_derivatives) {
      H_ = Eigen::MatrixXd::Zero(size, size);
      g_ = Eigen::VectorXd::Zero(size);
    }
    cost_ = squares_ = 0.0;
    count_ = 0;
    for (const KnownTrack& track : known_)
      for (const PlaceIn& place : track.places) {
        const HandHeld& camera = cameras_[place.image];
        add(place.pixel, with_derivatives, {{camera_at(place.image), 6}}, [&](const Eigen::VectorXd& step) {
          return lens_.pixel(camera.moved(step).to_camera(track.p_world));
        });
      }
    for (std::size_t k = 0; k < tracks_.size(); ++k) add_track(k, with_derivatives);
    return cost_;
  }

  /// Levenberg's step.
  [[nodiscard]] Eigen::VectorXd step(double damping) const {
    Eigen::MatrixXd damped = H_;
    damped.diagonal() *= 1.0 + damping;
    damped.diagonal().array() += 1e-9;
    return damped.ldlt().solve(g_);
  }

  void move(const Eigen::VectorXd& step) {
    for (std::size_t i = 1; i < cameras_.size(); ++i)
      cameras_[i] = cameras_[i].moved(step.segment<6>(camera_at(i)));
    for (std::size_t k = 0; k < tracks_.size(); ++k)
      tracks_[k].rho_per_m = std::max(kMinRho_per_m, tracks_[k].rho_per_m + step[ray_at(k)]);
  }

  [[nodiscard]] double rms_px() const { return std::sqrt(squares_ / (2.0 * count_)); }

 private:
  static constexpr double kMinRho_per_m = 0.05;
  static constexpr double kHuber_px = 1.0;
  struct Part {
    Eigen::Index at;  ///< below 0: of the first camera, which stays
    Eigen::Index size;
  };

  [[nodiscard]] static Eigen::Index camera_at(std::size_t i) { return 6 * static_cast<Eigen::Index>(i) - 6; }
  [[nodiscard]] Eigen::Index ray_at(std::size_t k) const {
    return camera_at(cameras_.size()) + static_cast<Eigen::Index>(k);
  }

  void add_track(std::size_t k, bool with_derivatives) {
    const RayTrack& track = tracks_[k];
    const HandHeld& anchor = cameras_[track.anchor];
    for (const PlaceIn& place : track.places) {
      if (place.image == track.anchor) continue;
      const HandHeld& camera = cameras_[place.image];
      add(place.pixel, with_derivatives,
          {{camera_at(place.image), 6}, {camera_at(track.anchor), 6}, {ray_at(k), 1}},
          [&](const Eigen::VectorXd& step) {
            const Eigen::Vector3d p_anchor = track.xy.homogeneous() / (track.rho_per_m + step[12]);
            return lens_.pixel(
                camera.moved(step.head<6>()).to_camera(anchor.moved(step.segment<6>(6)).to_world(p_anchor)));
          });
    }
  }

  /// One place; `predict` gives it after a small step of its parts.
  template <class Predict>
  void add(const Eigen::Vector2d& pixel, bool with_derivatives, std::initializer_list<Part> parts,
           const Predict& predict) {
    Eigen::Index size = 0;
    for (const Part& part : parts) size += part.size;
    Eigen::VectorXd at = Eigen::VectorXd::Zero(size);
    const auto h = predict(at);
    if (!h) return;
    const Eigen::Vector2d r = pixel - *h;
    const double weight = r.norm() <= kHuber_px ? 1.0 : kHuber_px / r.norm();
    cost_ += weight * (2.0 - weight) * r.squaredNorm();
    squares_ += weight * r.squaredNorm();
    ++count_;
    if (!with_derivatives) return;
    Eigen::MatrixXd J(2, size);
    for (Eigen::Index i = 0; i < size; ++i) {
      at[i] = kStep;
      J.col(i) = (predict(at).value_or(*h) - *h) / kStep;
      at[i] = 0.0;
    }
    Eigen::Index row = 0;
    for (const Part& a : parts) {
      Eigen::Index column = 0;
      for (const Part& b : parts) {
        if (a.at >= 0 && b.at >= 0)
          H_.block(a.at, b.at, a.size, b.size) +=
              weight * J.middleCols(row, a.size).transpose() * J.middleCols(column, b.size);
        column += b.size;
      }
      if (a.at >= 0) g_.segment(a.at, a.size) += weight * J.middleCols(row, a.size).transpose() * r;
      row += a.size;
    }
  }

  WideAngleLens lens_;
  std::span<HandHeld> cameras_;
  std::span<const KnownTrack> known_;
  std::span<RayTrack> tracks_;
  Eigen::MatrixXd H_;
  Eigen::VectorXd g_;
  double cost_ = 0.0, squares_ = 0.0;
  int count_ = 0;
};

}  // namespace

double bundle(const WideAngleLens& lens, std::span<HandHeld> cameras, std::span<const KnownTrack> known,
              std::span<RayTrack> tracks) {
  constexpr int kIterations = 60;
  Bundle bundle(lens, cameras, known, tracks);
  double damping = 1e-3;
  for (int i = 0; i < kIterations && damping < 1e6; ++i) {
    const double cost = bundle.linearize(true);
    const std::vector<HandHeld> cameras_before(cameras.begin(), cameras.end());
    const std::vector<RayTrack> tracks_before(tracks.begin(), tracks.end());
    bundle.move(bundle.step(damping));
    if (bundle.linearize(false) < cost) {
      damping *= 0.2;
      continue;
    }
    std::ranges::copy(cameras_before, cameras.begin());
    std::ranges::copy(tracks_before, tracks.begin());
    damping *= 10.0;
  }
  bundle.linearize(false);
  return bundle.rms_px();
}

std::optional<Eigen::Vector2d> WideAngleLens::pixel(const Eigen::Vector3d& p_camera) const {
  if (p_camera.z() <= 0.0) return std::nullopt;
  const Eigen::Vector2d ideal = -f_px * p_camera.head<2>() / p_camera.z();
  return centre_px + ideal / std::sqrt(1.0 + 2.0 * k_per_px2 * ideal.squaredNorm());
}

Eigen::Vector2d WideAngleLens::ray(const Eigen::Vector2d& pixel) const {
  const Eigen::Vector2d seen = pixel - centre_px;
  return -seen / std::sqrt(1.0 - 2.0 * k_per_px2 * seen.squaredNorm()) / f_px;
}

HandHeld HandHeld::moved(const Vector6d& step) const {
  const double angle_rad = step.head<3>().norm();
  HandHeld result = *this;
  if (angle_rad > 0.0)
    result.R_camera_world =
        R_camera_world * Eigen::AngleAxisd(angle_rad, step.head<3>() / angle_rad).toRotationMatrix();
  result.p_world_camera += step.tail<3>();
  return result;
}

std::optional<HandHeld> resect(const WideAngleLens& lens, const HandHeld& start,
                               std::span<const KnownObservation> observations, double sigma_px) {
  constexpr int kIterations = 20;
  constexpr double kSettled = 1e-8;
  if (observations.size() < 3) return std::nullopt;
  HandHeld place = start;
  for (int i = 0; i < kIterations; ++i) {
    const auto r = misfit(lens, place, observations);
    if (!r) return std::nullopt;
    Eigen::MatrixXd J(r->size(), 6);
    for (int axis = 0; axis < 6; ++axis) {
      const auto ahead = misfit(lens, place.moved(kStep * Vector6d::Unit(axis)), observations);
      if (!ahead) return std::nullopt;
      J.col(axis) = (*r - *ahead) / kStep;
    }
    const Eigen::LLT<Eigen::MatrixXd> information(J.transpose() * J);
    if (information.info() != Eigen::Success) return std::nullopt;
    const Vector6d step = information.solve(J.transpose() * *r);
    place = place.moved(step);
    if (step.norm() > kSettled) continue;
    place.covariance = sigma_px * sigma_px * information.solve(Eigen::MatrixXd::Identity(6, 6));
    const double rms_px = std::sqrt(r->squaredNorm() / static_cast<double>(r->size()));
    return rms_px < 3.0 * sigma_px ? std::optional(place) : std::nullopt;
  }
  return std::nullopt;
}

}  // namespace waymark
