#include "synthetic_run.hpp"

#include <algorithm>
#include <cmath>

#include "waymark/core/angle.hpp"
#include "waymark/core/random.hpp"
#include "waymark/models/observation_models.hpp"

namespace waymark::app {
namespace {

constexpr double kSpacing_m = 4.0;
constexpr double kStep_m = 0.3;

class Field {
 public:
  explicit Field(int landmarks) {
    const double half_m = 0.5 * kSpacing_m * std::sqrt(landmarks);
    for (int i = 0; i < landmarks; ++i)
      landmarks_.emplace_back(random_.uniform(-half_m, half_m), random_.uniform(-half_m, half_m));
    turn_rad_ = kStep_m / (0.5 * half_m);
  }

  Motion drive() {
    truth_ = truth_ * Pose2{kStep_m, 0.0, turn_rad_};
    const Pose2 measured{kStep_m + sigma_[0] * random_.normal(), sigma_[1] * random_.normal(),
                         turn_rad_ + sigma_[2] * random_.normal()};
    return {measured, sigma_.cwiseAbs2().asDiagonal()};
  }

  Observations look_at_all() {
    Observations all;
    for (std::size_t i = 0; i < landmarks_.size(); ++i) all.push_back(sight(i));
    return all;
  }

  Observations look_at_nearest(std::size_t count) {
    std::vector<std::size_t> order(landmarks_.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    const auto nearer = [this](std::size_t a, std::size_t b) { return distance_m(a) < distance_m(b); };
    std::ranges::partial_sort(order, order.begin() + static_cast<std::ptrdiff_t>(count), nearer);
    Observations nearest;
    for (std::size_t k = 0; k < count; ++k) nearest.push_back(sight(order[k]));
    return nearest;
  }

 private:
  [[nodiscard]] double distance_m(std::size_t i) const { return (landmarks_[i] - truth_.position()).norm(); }

  Observation sight(std::size_t i) {
    const Eigen::Vector2d sigma(0.05, to_radians(0.5));
    const auto z = RangeBearingModel::linearize(truth_, Pose2{}, landmarks_[i]).predicted;
    const RangeBearing noisy{z[0] + sigma[0] * random_.normal(),
                             wrap_angle(z[1] + sigma[1] * random_.normal())};
    return {LandmarkId{LandmarkId::Family::kMarker, static_cast<int>(i)}, noisy,
            Eigen::Matrix2d(sigma.cwiseAbs2().asDiagonal())};
  }

  RandomStream random_{1, StreamPurpose::kSimulation};
  std::vector<Eigen::Vector2d> landmarks_;
  Eigen::Vector3d sigma_{0.02, 0.02, to_radians(0.3)};
  double turn_rad_ = 0.0;
  Pose2 truth_;
};

}  // namespace

SyntheticRun make_synthetic_run(int landmarks, int observations_per_step, int steps) {
  Field field(landmarks);
  SyntheticRun run;
  run.start.covariance = Eigen::Vector3d(1e-4, 1e-4, 1e-5).asDiagonal();
  run.first_look = field.look_at_all();
  for (int i = 0; i < steps; ++i) {
    const Motion motion = field.drive();
    run.steps.push_back({motion, field.look_at_nearest(
                                     static_cast<std::size_t>(std::min(observations_per_step, landmarks)))});
  }
  return run;
}

}  // namespace waymark::app
