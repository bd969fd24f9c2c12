#include "waymark/kernels/particle_sightings.hpp"

#include <cmath>
#include <limits>

#include <Eigen/LU>

#include "support/matrix_near.hpp"
#include "support/numeric_jacobian.hpp"
#include "waymark/core/angle.hpp"
#include "waymark/models/observation_models.hpp"

#include "kernels/kernel_support.hpp"
#include "kernels/particle_support.hpp"

namespace waymark::kernels {
namespace {

using test::covariance_of;
using test::matrix_near;
using test::mean_of;
using test::ParticleScene;
using test::pose_of;

/// A way to see a landmark.
struct Case {
  const char* name;
  LandmarkForm form;
  SightingKind kind;
  std::size_t modes;
};

constexpr Case kCases[]{
    {"range and bearing of a point", LandmarkForm::kPoint, SightingKind::kRangeBearing, 1},
    {"range of a point", LandmarkForm::kPoint, SightingKind::kRange, 1},
    {"bearing of a point", LandmarkForm::kPoint, SightingKind::kBearing, 1},
    {"bearing of a ray", LandmarkForm::kRay, SightingKind::kBearing, 1},
    {"range of a ring", LandmarkForm::kRing, SightingKind::kRange, 1},
    {"range of a ring of five", LandmarkForm::kRing, SightingKind::kRange, 5}};

constexpr std::size_t kCounts[]{1, 7, 16, 37};

ParticleScene make_scene(const Case& c, std::size_t count, std::uint64_t seed = 1) {
  return {count, c.form, c.kind, c.modes, seed};
}

using Values = std::vector<std::vector<float>>;

/// Equal to a few units of float rounding, in the entries that belong to particles.
void expect_near(const Values& actual, const Values& expected, std::size_t count, double relative,
                 const char* name) {
  for (std::size_t c = 0; c < actual.size(); ++c)
    for (std::size_t i = 0; i < count; ++i)
      EXPECT_NEAR(actual[c][i], expected[c][i], relative * std::max(1.0F, std::abs(expected[c][i])))
          << name << ", column " << c << ", particle " << i;
}

class ParticleSightings : public test::OnEveryInstructionSet {
 protected:
  /// Runs `fast` and `plain` on the same scene and compares all that they leave behind.
  template <class Fast, class Plain>
  static void compare(const Case& c, const Fast& fast, const Plain& plain) {
    for (const std::size_t count : kCounts) {
      ParticleScene scene = make_scene(c, count);
      const Values before = scene.columns().values();
      fast(scene);
      const Values after = scene.columns().values();
      const std::vector<double> weights(scene.log_weight(), scene.log_weight() + count);
      scene.columns().restore(before);
      std::fill_n(scene.log_weight(), count, 0.0);
      plain(scene);
      expect_near(after, scene.columns().values(), count, 2e-5, c.name);
      for (std::size_t i = 0; i < count; ++i)
        EXPECT_NEAR(weights[i], scene.log_weight()[i], 1e-4 * (1.0 + std::abs(weights[i]))) << c.name;
    }
  }
};

WAYMARK_ON_EVERY_INSTRUCTION_SET(ParticleSightings);

TEST_P(ParticleSightings, UpdateAsTheScalarFormulaDoes) {
  for (const Case& c : kCases)
    compare(
        c, [](ParticleScene& s) { update_landmark(s.sighting, s.poses, 0.7, s.log_weight(), s.range()); },
        [](ParticleScene& s) {
          reference::update_landmark(s.sighting, s.poses, 0.7, s.log_weight(), s.range());
        });
}

TEST_P(ParticleSightings, ConditionAsTheScalarFormulaDoes) {
  for (const Case& c : kCases) {
    if (c.modes > 1) continue;
    compare(
        c,
        [](ParticleScene& s) {
          condition_increments(s.sighting, s.poses, 0.7, s.increments, s.log_weight(), s.range());
        },
        [](ParticleScene& s) {
          reference::condition_increments(s.sighting, s.poses, 0.7, s.increments, s.log_weight(), s.range());
        });
  }
}

TEST_P(ParticleSightings, PlaceAsTheScalarFormulaDoes) {
  const FirstGuess guess{0.5F, 0.1F, 0.3F, 0.02F};
  for (const Case& c : kCases)
    compare(
        c, [&](ParticleScene& s) { place_landmark(s.sighting, guess, s.poses, s.range()); },
        [&](ParticleScene& s) { reference::place_landmark(s.sighting, guess, s.poses, s.range()); });
}

TEST_P(ParticleSightings, CompareAsTheScalarFormulaDoes) {
  const Increment increment{0.1F, 0.02F, 0.05F, 2e-3F, 3e-4F, 2e-4F, 1e-3F, 4e-4F, 3e-3F};
  for (const Case& c : kCases)
    for (const std::size_t count : kCounts) {
      ParticleScene scene = make_scene(c, count);
      AlignedArray<double> weight(round_up_particles(count));
      for (std::size_t i = 0; i < count; ++i) weight[i] = random_.uniform();
      const About about{0.2F, -0.1F};
      const auto fast =
          compare_sighting(scene.sighting, increment, scene.poses, about, weight.data(), scene.range());
      const auto plain = reference::compare_sighting(scene.sighting, increment, scene.poses, about,
                                                     weight.data(), scene.range());
      for (std::size_t k = 0; k < fast.size(); ++k)
        EXPECT_NEAR(fast[k], plain[k], 2e-5 * (plain[0] + std::abs(plain[k]))) << c.name << ", term " << k;
    }
}

/// Where the landmark is, as function of (robot x, y, theta; a, b): what the measurement sees.
Eigen::Vector2d point_in_world(const ParticleScene& scene, std::size_t i, const Eigen::Vector2d& y) {
  const LandmarkView& l = scene.sighting.landmark;
  const Eigen::Vector2d offset(l.offset_x, l.offset_y);
  if (l.form == LandmarkForm::kPoint) return y + offset;
  const Eigen::Vector2d anchor = Eigen::Vector2d(l.anchor_x[i], l.anchor_y[i]) + offset;
  const double distance = l.form == LandmarkForm::kRay ? 1.0 / y[1] : y[1];
  return anchor + distance * Eigen::Vector2d(std::cos(y[0]), std::sin(y[0]));
}

/// The measurement function and its derivatives by central differences: independent of the kernels' formulas.
struct Textbook {
  Eigen::VectorXd nu;
  Eigen::MatrixXd R, H_pose, H_landmark;
};

Eigen::Vector2d predicted(const ParticleScene& scene, std::size_t i, const Eigen::Matrix<double, 5, 1>& at) {
  const SensorMount& mount = scene.sighting.mount;
  const Pose2 T_robot_sensor{mount.x, mount.y, std::atan2(mount.sin_yaw, mount.cos_yaw)};
  return RangeBearingModel::linearize({at[0], at[1], at[2]}, T_robot_sensor,
                                      point_in_world(scene, i, at.tail<2>()))
      .predicted;
}

Textbook textbook(const ParticleScene& scene, std::size_t i, const Pose2& robot) {
  const SeenLandmark& z = scene.sighting.seen;
  const SensorMount& mount = scene.sighting.mount;
  Eigen::Matrix<double, 5, 1> at;
  at << robot.x_m, robot.y_m, robot.theta_rad, mean_of(scene.gaussian(), i);
  const auto H = test::numeric_jacobian(
      [&](const Eigen::Matrix<double, 5, 1>& x) { return predicted(scene, i, x); }, at);
  const Eigen::Vector2d h = predicted(scene, i, at);
  const double bearing = std::atan2(z.sin_bearing, z.cos_bearing) - std::atan2(mount.sin_yaw, mount.cos_yaw);
  const Eigen::Vector2d nu(z.range - h[0], wrap_angle(bearing - h[1]));
  const Eigen::Matrix2d R = Eigen::Matrix2f{{z.R_rr, z.R_rb}, {z.R_rb, z.R_bb}}.cast<double>();
  const int first = z.kind == SightingKind::kBearing ? 1 : 0;
  const int rows = z.kind == SightingKind::kRangeBearing ? 2 : 1;
  return {nu.segment(first, rows), R.block(first, first, rows, rows), H.block(first, 0, rows, 3),
          H.block(first, 3, rows, 2)};
}

double log_normal(const Eigen::VectorXd& nu, const Eigen::MatrixXd& S) {
  return -0.5 * (nu.dot(S.inverse() * nu) + std::log(S.determinant()));
}

TEST(UpdateLandmark, IsTheTextbookFilter) {
  for (const Case& c : kCases) {
    if (c.modes > 1) continue;
    for (std::uint64_t seed = 1; seed < 6; ++seed) {
      ParticleScene before = make_scene(c, 20, seed);
      ParticleScene after = make_scene(c, 20, seed);
      update_landmark(after.sighting, after.poses, 1.0, after.log_weight(), after.range());
      before.sighting.mount.x = before.sighting.mount.y = 0.0F;  // the poses are those of sensors
      for (std::size_t i = 0; i < 20; ++i) {
        const Textbook t = textbook(before, i, pose_of(before.poses, i));
        const Eigen::Matrix2d Sigma = covariance_of(before.gaussian(), i);
        const Eigen::MatrixXd S = t.H_landmark * Sigma * t.H_landmark.transpose() + t.R;
        const Eigen::MatrixXd K = Sigma * t.H_landmark.transpose() * S.inverse();
        EXPECT_TRUE(matrix_near(mean_of(after.gaussian(), i), mean_of(before.gaussian(), i) + K * t.nu, 1e-5))
            << c.name;
        EXPECT_TRUE(matrix_near(covariance_of(after.gaussian(), i), Sigma - K * S * K.transpose(), 1e-6))
            << c.name;
        EXPECT_NEAR(after.log_weight()[i], log_normal(t.nu, S), 1e-3 + 1e-5 * std::abs(after.log_weight()[i]))
            << c.name;
      }
    }
  }
}

TEST(ConditionIncrements, IsTheTextbookFilterOfTheRobotsMotion) {
  for (const Case& c : kCases) {
    if (c.modes > 1) continue;
    ParticleScene before = make_scene(c, 20);
    ParticleScene after = make_scene(c, 20);
    condition_increments(after.sighting, after.poses, 1.0, after.increments, after.log_weight(),
                         after.range());
    for (std::size_t i = 0; i < 20; ++i) {
      const Pose2 start = pose_of(before.poses, i);
      const Eigen::Vector3d d = mean_of(before.increments, i);
      const Textbook t = textbook(before, i, start * Pose2{d[0], d[1], d[2]});
      const Eigen::MatrixXd G = t.H_pose * compose_jacobian_right(start);
      const Eigen::Matrix2d Sigma = covariance_of(before.gaussian(), i);
      const Eigen::Matrix3d P = covariance_of(before.increments, i);
      const Eigen::MatrixXd L = G * P * G.transpose() + t.H_landmark * Sigma * t.H_landmark.transpose() + t.R;
      const Eigen::MatrixXd K = P * G.transpose() * L.inverse();
      EXPECT_TRUE(matrix_near(mean_of(after.increments, i), d + K * t.nu, 1e-5)) << c.name;
      EXPECT_TRUE(matrix_near(covariance_of(after.increments, i), P - K * L * K.transpose(), 1e-6)) << c.name;
      EXPECT_NEAR(after.log_weight()[i], log_normal(t.nu, L), 1e-3 + 1e-5 * std::abs(after.log_weight()[i]))
          << c.name;
    }
  }
}

TEST(CompareSighting, GivesTheMomentsOfTheMixture) {
  const Increment increment{0.1F, 0.02F, 0.05F, 2e-3F, 3e-4F, 2e-4F, 1e-3F, 4e-4F, 3e-3F};
  const Eigen::Matrix3d P =
      Eigen::Matrix3f{{2e-3F, 3e-4F, 2e-4F}, {3e-4F, 1e-3F, 4e-4F}, {2e-4F, 4e-4F, 3e-3F}}.cast<double>();
  ParticleScene scene = make_scene(kCases[0], 20);
  AlignedArray<double> weight(32);
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  Eigen::Matrix2d second = Eigen::Matrix2d::Zero();
  for (std::size_t i = 0; i < 20; ++i) {
    weight[i] = 0.01 * static_cast<double>(i);
    const Pose2 start = pose_of(scene.poses, i);
    const Textbook t = textbook(scene, i, start * Pose2{0.1, 0.02, 0.05});
    const Eigen::MatrixXd G = t.H_pose * compose_jacobian_right(start);
    const Eigen::Matrix2d L = G * P * G.transpose() +
                              t.H_landmark * covariance_of(scene.gaussian(), i) * t.H_landmark.transpose() +
                              t.R;
    mean += weight[i] * t.nu;
    second += weight[i] * (L + t.nu * t.nu.transpose());
  }
  const auto sums =
      compare_sighting(scene.sighting, increment, scene.poses, {}, weight.data(), scene.range());
  EXPECT_NEAR(sums[0], 1.9, 1e-6);
  EXPECT_TRUE(matrix_near(Eigen::Vector2d(sums[1], sums[2]), mean, 1e-5));
  EXPECT_TRUE(matrix_near(Eigen::Matrix2d{{sums[3], sums[4]}, {sums[4], sums[5]}}, second, 1e-5));
}

TEST(UpdateLandmark, StaysPositiveDefiniteHoweverSharpTheSensor) {
  ParticleScene scene = make_scene(kCases[0], 37);
  scene.sighting.seen.R_rr = 1e-12F;
  scene.sighting.seen.R_rb = 0.0F;
  scene.sighting.seen.R_bb = 1e-12F;
  for (int sighting = 0; sighting < 10'000; ++sighting)
    update_landmark(scene.sighting, scene.poses, 1.0, scene.log_weight(), scene.range());
  for (std::size_t i = 0; i < scene.count(); ++i) {
    const Eigen::Matrix2d Sigma = covariance_of(scene.gaussian(), i);
    EXPECT_GT(Sigma(0, 0), 0.0);
    EXPECT_GT(Sigma(1, 1), 0.0);
    EXPECT_LE(Sigma(0, 1) * Sigma(0, 1), Sigma(0, 0) * Sigma(1, 1) * (1.0 + 1e-6));
    EXPECT_TRUE(mean_of(scene.gaussian(), i).allFinite());
  }
}

TEST(UpdateLandmark, IsFiniteWithALandmarkOnTheSensor) {
  for (const Case& c : kCases) {
    if (c.form != LandmarkForm::kPoint) continue;
    ParticleScene scene = make_scene(c, 16);
    for (std::size_t i = 0; i < 16; ++i) {
      scene.gaussian().a[i] = scene.poses.x[i] - scene.sighting.landmark.offset_x;
      scene.gaussian().b[i] = scene.poses.y[i] - scene.sighting.landmark.offset_y;
    }
    update_landmark(scene.sighting, scene.poses, 1.0, scene.log_weight(), scene.range());
    for (std::size_t i = 0; i < 16; ++i) {
      EXPECT_TRUE(std::isfinite(scene.log_weight()[i])) << c.name;
      EXPECT_TRUE(mean_of(scene.gaussian(), i).allFinite()) << c.name;
    }
  }
}

TEST(UpdateLandmark, ARayNeverReachesBeyondTheSensorsRange) {
  ParticleScene scene = make_scene(kCases[3], 16);
  // Seen in one direction for long from the far sides: a wall of noise would put it behind infinity.
  for (std::size_t i = 0; i < 16; ++i) scene.gaussian().b[i] = -0.5F;
  update_landmark(scene.sighting, scene.poses, 1.0, scene.log_weight(), scene.range());
  for (std::size_t i = 0; i < 16; ++i) EXPECT_GE(scene.gaussian().b[i], scene.sighting.mount.least_rho);
}

/// log sum_k w_k N(nu_k; 0, S_k) V_k, and the posterior weights, with V_k the chance to be in view.
TEST(UpdateLandmark, WeighsHypothesesByTheirLikelihood) {
  ParticleScene before = make_scene(kCases[5], 20);
  ParticleScene after = make_scene(kCases[5], 20);
  before.sighting.mount.half_view = after.sighting.mount.half_view = 4.0F;  // sees all round
  update_landmark(after.sighting, after.poses, 1.0, after.log_weight(), after.range());
  before.sighting.mount.x = before.sighting.mount.y = 0.0F;
  for (std::size_t i = 0; i < 20; ++i) {
    double likelihood = 0.0;
    std::vector<double> parts;
    for (const LandmarkMode& mode : before.modes()) {
      ParticleScene alone = make_scene(kCases[4], 20);
      alone.sighting.mount = before.sighting.mount;
      alone.sighting.landmark.anchor_x[i] = before.sighting.landmark.anchor_x[i];
      alone.sighting.landmark.anchor_y[i] = before.sighting.landmark.anchor_y[i];
      alone.gaussian().a[i] = mode.gaussian.a[i];
      alone.gaussian().b[i] = mode.gaussian.b[i];
      const Textbook t = textbook(alone, i, pose_of(before.poses, i));
      const Eigen::MatrixXd S =
          t.H_landmark * covariance_of(mode.gaussian, i) * t.H_landmark.transpose() + t.R;
      parts.push_back(std::exp(log_normal(t.nu, S)) / 5.0);
      likelihood += parts.back();
    }
    EXPECT_NEAR(after.log_weight()[i], std::log(likelihood), 1e-3 * (1.0 + std::abs(std::log(likelihood))));
    double sum = 0.0;
    for (std::size_t k = 0; k < 5; ++k) {
      const double weight = std::exp(after.modes()[k].log_weight[i]);
      sum += weight;
      EXPECT_NEAR(weight, parts[k] / likelihood, 5e-3);
    }
    EXPECT_NEAR(sum, 1.0, 1e-4);
  }
}

TEST(UpdateLandmark, DropsHypothesesOutsideTheFieldOfView) {
  ParticleScene scene = make_scene(kCases[5], 16);
  scene.sighting.mount.half_view = 0.2F;
  for (std::size_t i = 0; i < 16; ++i) {
    scene.poses.cos[i] = std::cos(0.4F - 0.5F);  // the axis of the sensor, 0.5 to the left, points at 0.4
    scene.poses.sin[i] = std::sin(0.4F - 0.5F);
    for (const LandmarkMode& mode : scene.modes()) mode.gaussian.aa[i] = 1e-3F;
  }
  for (int sighting = 0; sighting < 5; ++sighting)
    update_landmark(scene.sighting, scene.poses, 1.0, scene.log_weight(), scene.range());
  for (std::size_t i = 0; i < 16; ++i) {
    EXPECT_EQ(scene.modes()[0].log_weight[i], kDeadMode);  // 0.6 rad off the axis
    EXPECT_EQ(scene.modes()[4].log_weight[i], kDeadMode);
    EXPECT_GT(scene.modes()[2].log_weight[i], -10.0F);
  }
}

TEST(PlaceLandmark, InvertsTheMeasurementOfAPoint) {
  ParticleScene scene = make_scene(kCases[0], 20);
  place_landmark(scene.sighting, {}, scene.poses, scene.range());
  const SeenLandmark& z = scene.sighting.seen;
  const Eigen::Matrix2d R = Eigen::Matrix2f{{z.R_rr, z.R_rb}, {z.R_rb, z.R_bb}}.cast<double>();
  for (std::size_t i = 0; i < 20; ++i) {
    const auto inverse = RangeBearingModel::locate(pose_of(scene.poses, i), {},
                                                   {z.range, std::atan2(z.sin_bearing, z.cos_bearing)});
    EXPECT_TRUE(matrix_near(point_in_world(scene, i, mean_of(scene.gaussian(), i)), inverse.p_world, 1e-5));
    EXPECT_TRUE(matrix_near(covariance_of(scene.gaussian(), i),
                            inverse.G_measurement * R * inverse.G_measurement.transpose(), 1e-6));
  }
}

TEST(PlaceLandmark, RaysAndRingsBeginAtTheirSensor) {
  const FirstGuess guess{0.5F, 0.1F, 0.3F, 0.02F};
  for (const Case& c : kCases) {
    if (c.form == LandmarkForm::kPoint) continue;
    ParticleScene scene = make_scene(c, 20);
    place_landmark(scene.sighting, guess, scene.poses, scene.range());
    const bool is_ray = c.form == LandmarkForm::kRay;
    for (std::size_t i = 0; i < 20; ++i) {
      const LandmarkView& l = scene.sighting.landmark;
      EXPECT_NEAR(l.anchor_x[i] + l.offset_x, scene.poses.x[i], 1e-6F);
      EXPECT_NEAR(l.anchor_y[i] + l.offset_y, scene.poses.y[i], 1e-6F);
      // The ray goes where the landmark was seen, the ring is symmetric to the sensor's axis.
      const double direction = pose_of(scene.poses, i).theta_rad + (is_ray ? 0.4 : 0.5);
      double mean_phi = 0.0;
      for (const LandmarkMode& mode : scene.modes())
        mean_phi += mode.gaussian.a[i] / static_cast<double>(c.modes);
      EXPECT_NEAR(mean_phi, direction, 1e-5) << c.name;
      EXPECT_EQ(scene.gaussian().b[i], is_ray ? guess.rho : scene.sighting.seen.range);
      EXPECT_EQ(scene.gaussian().aa[i], is_ray ? scene.sighting.seen.R_bb : guess.phi_var);
    }
    if (c.modes == 5) {
      EXPECT_NEAR(scene.gaussian(4).a[3] - scene.gaussian(0).a[3], 4.0F * guess.phi_spacing, 1e-5F);
    }
  }
}

}  // namespace
}  // namespace waymark::kernels
