#include "waymark/kernels/particle_observations.hpp"

#include <algorithm>
#include <array>
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
  ObservationKind kind;
  std::size_t modes;
};

constexpr Case kCases[]{
    {"range and bearing of a point", LandmarkForm::kPoint, ObservationKind::kRangeBearing, 1},
    {"range of a point", LandmarkForm::kPoint, ObservationKind::kRange, 1},
    {"bearing of a point", LandmarkForm::kPoint, ObservationKind::kBearing, 1},
    {"bearing of a ray", LandmarkForm::kRay, ObservationKind::kBearing, 1},
    {"range of a ring", LandmarkForm::kRing, ObservationKind::kRange, 1},
    {"range of a ring of five", LandmarkForm::kRing, ObservationKind::kRange, 5},
    {"bearing of a ray of five", LandmarkForm::kRay, ObservationKind::kBearing, 5},
    {"edge of the view at a point", LandmarkForm::kPoint, ObservationKind::kViewEdge, 1},
    {"edge of the view at a ring", LandmarkForm::kRing, ObservationKind::kViewEdge, 1},
    {"edge of the view at a ring of five", LandmarkForm::kRing, ObservationKind::kViewEdge, 5}};

constexpr std::size_t kCounts[]{1, 7, 16, 37};

constexpr Increment kIncrement{0.1F, 0.02F, 0.05F, 2e-3F, 3e-4F, 2e-4F, 1e-3F, 4e-4F, 3e-3F};

ParticleScene make_scene(const Case& c, std::size_t count, std::uint64_t seed = 1) {
  return {count, c.form, c.kind, c.modes, seed};
}

/// A hypothesis for each mode, all different.
FirstGuess make_guess() {
  FirstGuess guess;
  for (std::size_t k = 0; k < guess.modes.size(); ++k) {
    const auto step = static_cast<float>(k);
    guess.modes[k] = {0.5F - 0.1F * step, 0.02F + 0.001F * step, -0.5F - 0.1F * step};
  }
  return guess;
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

class ParticleObservations : public test::OnEveryInstructionSet {
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

WAYMARK_ON_EVERY_INSTRUCTION_SET(ParticleObservations);

TEST_P(ParticleObservations, UpdateAsTheScalarFormulaDoes) {
  for (const Case& c : kCases)
    compare(
        c, [](ParticleScene& s) { update_landmark(s.observation, s.poses, 0.7, s.log_weight(), s.range()); },
        [](ParticleScene& s) {
          reference::update_landmark(s.observation, s.poses, 0.7, s.log_weight(), s.range());
        });
}

TEST_P(ParticleObservations, ConditionAsTheScalarFormulaDoes) {
  for (const Case& c : kCases)
    compare(
        c,
        [](ParticleScene& s) {
          condition_increments(s.observation, kIncrement, s.poses, 0.7, s.increments, s.log_weight(),
                               s.range());
        },
        [](ParticleScene& s) {
          reference::condition_increments(s.observation, kIncrement, s.poses, 0.7, s.increments,
                                          s.log_weight(), s.range());
        });
}

TEST_P(ParticleObservations, MissAsTheScalarFormulaDoes) {
  for (const Case& c : kCases) {
    if (c.modes == 1) continue;
    compare(
        c, [](ParticleScene& s) { miss_modes(s.observation, 0.9, s.poses, s.range()); },
        [](ParticleScene& s) { reference::miss_modes(s.observation, 0.9, s.poses, s.range()); });
  }
}

TEST_P(ParticleObservations, PlaceAsTheScalarFormulaDoes) {
  const FirstGuess guess = make_guess();
  for (const Case& c : kCases)
    compare(
        c, [&](ParticleScene& s) { place_landmark(s.observation, guess, s.poses, s.range()); },
        [&](ParticleScene& s) { reference::place_landmark(s.observation, guess, s.poses, s.range()); });
}

TEST_P(ParticleObservations, EachParticleUnderstandsARangeInItsOwnWay) {
  for (const Case& c : kCases) {
    if (c.kind == ObservationKind::kBearing) continue;
    const auto with_errors = [](ParticleScene& scene, AlignedArray<float>& offset,
                                AlignedArray<float>& factor) {
      RandomStream random(7, StreamPurpose::kWorld);
      for (std::size_t k = 0; k < offset.size(); ++k) {
        offset[k] = static_cast<float>(0.2 * random.normal());
        factor[k] = static_cast<float>(1.0 + 0.05 * random.normal());
      }
      scene.observation.seen.range_errors = {offset.data(), factor.data()};
    };
    AlignedArray<float> offset(64);
    AlignedArray<float> factor(64);
    compare(
        c,
        [&](ParticleScene& s) {
          with_errors(s, offset, factor);
          update_landmark(s.observation, s.poses, 0.7, s.log_weight(), s.range());
        },
        [&](ParticleScene& s) {
          with_errors(s, offset, factor);
          reference::update_landmark(s.observation, s.poses, 0.7, s.log_weight(), s.range());
        });
  }
}

TEST_P(ParticleObservations, ARangeOfKnownErrorsIsTheRangeWithoutThem) {
  for (const Case& c : kCases) {
    if (c.kind == ObservationKind::kBearing) continue;
    AlignedArray<float> offset(64);
    AlignedArray<float> factor(64);
    std::fill_n(offset.data(), offset.size(), 0.5F);
    std::fill_n(factor.data(), factor.size(), 1.0F / 1.25F);
    compare(
        c,
        [&](ParticleScene& s) {
          s.observation.seen.range_errors = {offset.data(), factor.data()};
          s.observation.seen.range = 0.5F + 1.25F * 5.0F;
          update_landmark(s.observation, s.poses, 0.7, s.log_weight(), s.range());
        },
        [](ParticleScene& s) {
          s.observation.seen.range_errors = {};
          s.observation.seen.range = 5.0F;
          reference::update_landmark(s.observation, s.poses, 0.7, s.log_weight(), s.range());
        });
  }
}

TEST_P(ParticleObservations, CompareAsTheScalarFormulaDoes) {
  for (const Case& c : kCases)
    for (const std::size_t count : kCounts) {
      ParticleScene scene = make_scene(c, count);
      AlignedArray<double> weight(round_up_particles(count));
      for (std::size_t i = 0; i < count; ++i) weight[i] = random_.uniform();
      const About about{0.2F, -0.1F};
      const auto fast = compare_observation(scene.observation, kIncrement, scene.poses, about, weight.data(),
                                            scene.range());
      const auto plain = reference::compare_observation(scene.observation, kIncrement, scene.poses, about,
                                                        weight.data(), scene.range());
      const auto expect_near = [&](double a, double b, const char* what) {
        EXPECT_NEAR(a, b, 2e-5 * (plain.w + std::abs(b))) << c.name << ", " << what;
      };
      expect_near(fast.w, plain.w, "w");
      for (std::size_t k = 0; k < 2; ++k) expect_near(fast.nu[k], plain.nu[k], "nu");
      for (std::size_t k = 0; k < 3; ++k) expect_near(fast.nu_nu[k], plain.nu_nu[k], "nu nu");
      for (std::size_t k = 0; k < 3; ++k) expect_near(fast.L[k], plain.L[k], "L");
    }
}

TEST_P(ParticleObservations, ListInnovationsAsTheScalarFormulaDoes) {
  const About about{0.2F, -0.1F};
  for (const Case& c : kCases) {
    ParticleScene scene = make_scene(c, 37);
    float* const fast[]{scene.columns().add(), scene.columns().add()};
    float* const plain[]{scene.columns().add(), scene.columns().add()};
    list_innovations(scene.observation, kIncrement, scene.poses, about, fast[0], fast[1], scene.range());
    reference::list_innovations(scene.observation, kIncrement, scene.poses, about, plain[0], plain[1],
                                scene.range());
    for (std::size_t i = 0; i < 37; ++i)
      for (int k = 0; k < 2; ++k) EXPECT_NEAR(fast[k][i], plain[k][i], 1e-5) << c.name;
  }
}

/// Where the landmark is, as function of (robot x, y, theta; a, b): what the measurement sees.
Eigen::Vector2d point_in_world(const ParticleScene& scene, std::size_t i, const Eigen::Vector2d& y) {
  const LandmarkView& l = scene.observation.landmark;
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
  const SensorMount& mount = scene.observation.mount;
  const Pose2 T_robot_sensor{mount.x, mount.y, std::atan2(mount.sin_yaw, mount.cos_yaw)};
  return RangeBearingModel::linearize({at[0], at[1], at[2]}, T_robot_sensor,
                                      point_in_world(scene, i, at.tail<2>()))
      .predicted;
}

bool is_range(ObservationKind kind) {
  return kind == ObservationKind::kRangeBearing || kind == ObservationKind::kRange;
}

/// The bearing that was seen: for an edge of the view the one nearer to what is expected.
double seen_bearing(const ParticleScene& scene, double expected) {
  const auto& [seen, mount, landmark] = scene.observation;
  if (seen.kind == ObservationKind::kViewEdge) return std::copysign(mount.half_view, wrap_angle(expected));
  return std::atan2(seen.sin_bearing, seen.cos_bearing) - std::atan2(mount.sin_yaw, mount.cos_yaw);
}

Textbook textbook(const ParticleScene& scene, std::size_t i, const Pose2& robot, std::size_t mode = 0) {
  const LandmarkMeasurement& z = scene.observation.seen;
  Eigen::Matrix<double, 5, 1> at;
  at << robot.x_m, robot.y_m, robot.theta_rad, mean_of(scene.gaussian(mode), i);
  const auto H = test::numeric_jacobian(
      [&](const Eigen::Matrix<double, 5, 1>& x) { return predicted(scene, i, x); }, at);
  const Eigen::Vector2d h = predicted(scene, i, at);
  const Eigen::Vector2d nu(z.range - h[0], wrap_angle(seen_bearing(scene, h[1]) - h[1]));
  const Eigen::Matrix2d R = Eigen::Matrix2f{{z.R_rr, z.R_rb}, {z.R_rb, z.R_bb}}.cast<double>();
  const int first = is_range(z.kind) ? 0 : 1;
  const int rows = z.kind == ObservationKind::kRangeBearing ? 2 : 1;
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
      update_landmark(after.observation, after.poses, 1.0, after.log_weight(), after.range());
      before.observation.mount.x = before.observation.mount.y = 0.0F;  // the poses are those of sensors
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

/// The robot after it moved by s * d: the function whose derivative by s a filter of s needs.
Pose2 end_of(const Pose2& start, const Eigen::Vector3d& s) {
  return start * Pose2{s[0], s[1], s[2]} * Pose2{kIncrement.x, kIncrement.y, kIncrement.t};
}

/// d(measurement)/ds by central differences.
Eigen::MatrixXd jacobian_of_motion(const ParticleScene& scene, std::size_t i, const Pose2& start,
                                   const Eigen::Vector3d& s, std::size_t mode = 0) {
  const Eigen::Vector2d y = mean_of(scene.gaussian(mode), i);
  const auto H = test::numeric_jacobian(
      [&](const Eigen::Vector3d& x) {
        const Pose2 robot = end_of(start, x);
        Eigen::Matrix<double, 5, 1> at;
        at << robot.x_m, robot.y_m, robot.theta_rad, y;
        return predicted(scene, i, at);
      },
      s);
  const ObservationKind kind = scene.observation.seen.kind;
  const int rows = kind == ObservationKind::kRangeBearing ? 2 : 1;
  return H.block(is_range(kind) ? 0 : 1, 0, rows, 3);
}

TEST(ConditionIncrements, IsTheTextbookFilterOfTheRobotsMotion) {
  for (const Case& c : kCases) {
    if (c.modes > 1) continue;
    ParticleScene before = make_scene(c, 20);
    ParticleScene after = make_scene(c, 20);
    condition_increments(after.observation, kIncrement, after.poses, 1.0, after.increments,
                         after.log_weight(), after.range());
    for (std::size_t i = 0; i < 20; ++i) {
      const Pose2 start = pose_of(before.poses, i);
      const Eigen::Vector3d s = mean_of(before.increments, i);
      const Textbook t = textbook(before, i, end_of(start, s));
      const Eigen::MatrixXd G = jacobian_of_motion(before, i, start, s);
      const Eigen::Matrix2d Sigma = covariance_of(before.gaussian(), i);
      const Eigen::Matrix3d P = covariance_of(before.increments, i);
      const Eigen::MatrixXd L = G * P * G.transpose() + t.H_landmark * Sigma * t.H_landmark.transpose() + t.R;
      const Eigen::MatrixXd K = P * G.transpose() * L.inverse();
      EXPECT_TRUE(matrix_near(mean_of(after.increments, i), s + K * t.nu, 1e-5)) << c.name;
      EXPECT_TRUE(matrix_near(covariance_of(after.increments, i), P - K * L * K.transpose(), 1e-6)) << c.name;
      EXPECT_NEAR(after.log_weight()[i], log_normal(t.nu, L), 1e-3 + 1e-5 * std::abs(after.log_weight()[i]))
          << c.name;
    }
  }
}

/// Unequal weights; one hypothesis is dropped and holds nothing that is a number.
void weigh_modes(ParticleScene& scene) {
  constexpr float kWeights[]{0.1F, 0.2F, 0.3F, 0.0F, 0.4F};
  for (std::size_t i = 0; i < scene.count(); ++i)
    for (std::size_t k = 0; k < 5; ++k)
      scene.modes()[k].log_weight[i] = kWeights[k] > 0.0F ? std::log(kWeights[k]) : kDeadMode;
  for (std::size_t i = 0; i < scene.count(); ++i)
    scene.gaussian(3).a[i] = scene.gaussian(3).bb[i] = std::numeric_limits<float>::quiet_NaN();
}

double weight_of(const ParticleScene& scene, std::size_t mode, std::size_t i) {
  return std::exp(static_cast<double>(scene.modes()[mode].log_weight[i]));
}

TEST(ConditionIncrements, SeveralHypothesesCountByTheMomentsOfTheirMixture) {
  for (const Case& c : kCases) {
    if (c.modes == 1) continue;
    ParticleScene before = make_scene(c, 20);
    weigh_modes(before);
    ParticleScene after = make_scene(c, 20);
    weigh_modes(after);
    condition_increments(after.observation, kIncrement, after.poses, 1.0, after.increments,
                         after.log_weight(), after.range());
    for (std::size_t i = 0; i < 20; ++i) {
      const Pose2 start = pose_of(before.poses, i);
      const Eigen::Vector3d s = mean_of(before.increments, i);
      const Eigen::Matrix3d P = covariance_of(before.increments, i);
      double nu = 0.0;
      double second = 0.0;
      Eigen::RowVector3d G = Eigen::RowVector3d::Zero();
      for (const std::size_t k : {0U, 1U, 2U, 4U}) {
        const double w = weight_of(before, k, i);
        const Textbook t = textbook(before, i, end_of(start, s), k);
        const Eigen::RowVector3d G_k = jacobian_of_motion(before, i, start, s, k);
        const Eigen::Matrix2d Sigma = covariance_of(before.gaussian(k), i);
        nu += w * t.nu[0];
        second += w * (t.nu[0] * t.nu[0] + G_k * P * G_k.transpose() +
                       (t.H_landmark * Sigma * t.H_landmark.transpose() + t.R)(0, 0));
        G += w * G_k;
      }
      const double L = second - nu * nu;
      const Eigen::Vector3d K = P * G.transpose() / L;
      EXPECT_TRUE(matrix_near(mean_of(after.increments, i), s + K * nu, 1e-5)) << c.name;
      EXPECT_TRUE(matrix_near(covariance_of(after.increments, i), P - K * L * K.transpose(), 1e-6)) << c.name;
      EXPECT_NEAR(after.log_weight()[i], -0.5 * (nu * nu / L + std::log(L)), 1e-3) << c.name;
    }
  }
}

TEST(ConditionIncrements, WithoutAnyHypothesisLeftNothingIsLearnt) {
  for (const Case& c : kCases) {
    if (c.modes == 1) continue;
    ParticleScene scene = make_scene(c, 16);
    const ParticleScene before = make_scene(c, 16);
    for (std::size_t i = 0; i < 16; ++i)
      for (const LandmarkMode& mode : scene.modes()) {
        mode.log_weight[i] = kDeadMode;
        mode.gaussian.a[i] = std::numeric_limits<float>::infinity();
      }
    condition_increments(scene.observation, kIncrement, scene.poses, 1.0, scene.increments,
                         scene.log_weight(), scene.range());
    for (std::size_t i = 0; i < 16; ++i) {
      EXPECT_TRUE(std::isfinite(scene.log_weight()[i])) << c.name;
      EXPECT_EQ(mean_of(scene.increments, i), mean_of(before.increments, i)) << c.name;
      EXPECT_EQ(covariance_of(scene.increments, i), covariance_of(before.increments, i)) << c.name;
    }
  }
}

TEST(ListInnovations, OfSeveralHypothesesTheMeanCounts) {
  const About about{0.2F, -0.1F};
  for (const Case& c : kCases) {
    if (c.modes == 1) continue;
    ParticleScene scene = make_scene(c, 20);
    weigh_modes(scene);
    float* const nu_r = scene.columns().add();
    float* const nu_b = scene.columns().add();
    list_innovations(scene.observation, kIncrement, scene.poses, about, nu_r, nu_b, scene.range());
    const bool has_range = is_range(c.kind);
    for (std::size_t i = 0; i < 20; ++i) {
      const Pose2 robot = end_of(pose_of(scene.poses, i), Eigen::Vector3d::Zero());
      double mean = 0.0;
      for (const std::size_t k : {0U, 1U, 2U, 4U})
        mean += weight_of(scene, k, i) *
                (textbook(scene, i, robot, k).nu[0] - (has_range ? about.range : about.bearing));
      EXPECT_NEAR((has_range ? nu_r : nu_b)[i], mean, 1e-5) << c.name;
    }
  }
}

TEST(CompareObservation, GivesTheMomentsOfTheMixture) {
  const Increment& d = kIncrement;
  const Eigen::Matrix3d P =
      Eigen::Matrix3f{{d.xx, d.xy, d.xt}, {d.xy, d.yy, d.yt}, {d.xt, d.yt, d.tt}}.cast<double>();
  ParticleScene scene = make_scene(kCases[0], 20);
  AlignedArray<double> weight(32);
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  Eigen::Matrix2d second = Eigen::Matrix2d::Zero();
  Eigen::Matrix2d noise = Eigen::Matrix2d::Zero();
  for (std::size_t i = 0; i < 20; ++i) {
    weight[i] = 0.01 * static_cast<double>(i);
    const Pose2 start = pose_of(scene.poses, i);
    const Textbook t = textbook(scene, i, end_of(start, Eigen::Vector3d::Zero()));
    const Eigen::MatrixXd G = jacobian_of_motion(scene, i, start, Eigen::Vector3d::Zero());
    noise += weight[i] * (G * P * G.transpose() + t.R +
                          t.H_landmark * covariance_of(scene.gaussian(), i) * t.H_landmark.transpose());
    mean += weight[i] * t.nu;
    second += weight[i] * t.nu * t.nu.transpose();
  }
  const auto sums = compare_observation(scene.observation, d, scene.poses, {}, weight.data(), scene.range());
  const auto matrix = [](const std::array<double, 3>& m) {
    return Eigen::Matrix2d{{m[0], m[1]}, {m[1], m[2]}};
  };
  EXPECT_NEAR(sums.w, 1.9, 1e-6);
  EXPECT_TRUE(matrix_near(Eigen::Vector2d(sums.nu[0], sums.nu[1]), mean, 1e-5));
  EXPECT_TRUE(matrix_near(matrix(sums.nu_nu), second, 1e-5));
  EXPECT_TRUE(matrix_near(matrix(sums.L), noise, 1e-5));
}

TEST(UpdateLandmark, StaysPositiveDefiniteHoweverSharpTheSensor) {
  ParticleScene scene = make_scene(kCases[0], 37);
  scene.observation.seen.R_rr = 1e-12F;
  scene.observation.seen.R_rb = 0.0F;
  scene.observation.seen.R_bb = 1e-12F;
  for (int observation = 0; observation < 10'000; ++observation)
    update_landmark(scene.observation, scene.poses, 1.0, scene.log_weight(), scene.range());
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
      scene.gaussian().a[i] = scene.poses.x[i] - scene.observation.landmark.offset_x;
      scene.gaussian().b[i] = scene.poses.y[i] - scene.observation.landmark.offset_y;
    }
    update_landmark(scene.observation, scene.poses, 1.0, scene.log_weight(), scene.range());
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
  update_landmark(scene.observation, scene.poses, 1.0, scene.log_weight(), scene.range());
  for (std::size_t i = 0; i < 16; ++i) EXPECT_GE(scene.gaussian().b[i], scene.observation.mount.min_rho);
}

/// log sum_k w_k N(nu_k; 0, S_k), and the posterior weights.
TEST(UpdateLandmark, WeighsHypothesesByTheirLikelihood) {
  for (const Case& c : kCases) {
    if (c.modes == 1) continue;
    ParticleScene before = make_scene(c, 20);
    ParticleScene after = make_scene(c, 20);
    if (c.kind == ObservationKind::kRange)
      before.observation.mount.half_view = after.observation.mount.half_view = 4.0F;  // sees all round
    update_landmark(after.observation, after.poses, 1.0, after.log_weight(), after.range());
    before.observation.mount.x = before.observation.mount.y = 0.0F;
    for (std::size_t i = 0; i < 20; ++i) {
      double likelihood = 0.0;
      std::vector<double> parts;
      for (std::size_t k = 0; k < 5; ++k) {
        const Textbook t = textbook(before, i, pose_of(before.poses, i), k);
        const Eigen::MatrixXd S =
            t.H_landmark * covariance_of(before.gaussian(k), i) * t.H_landmark.transpose() + t.R;
        parts.push_back(std::exp(log_normal(t.nu, S)) / 5.0);
        likelihood += parts.back();
      }
      EXPECT_NEAR(after.log_weight()[i], std::log(likelihood), 1e-3 * (1.0 + std::abs(std::log(likelihood))))
          << c.name;
      double sum = 0.0;
      for (std::size_t k = 0; k < 5; ++k) {
        sum += weight_of(after, k, i);
        EXPECT_NEAR(weight_of(after, k, i), parts[k] / likelihood, 5e-3) << c.name;
      }
      EXPECT_NEAR(sum, 1.0, 1e-4) << c.name;
    }
  }
}

TEST(UpdateLandmark, DropsHypothesesOutsideTheFieldOfView) {
  ParticleScene scene = make_scene(kCases[5], 16);
  scene.observation.mount.half_view = 0.2F;
  for (std::size_t i = 0; i < 16; ++i) {
    scene.poses.cos[i] = std::cos(0.4F - 0.5F);  // the axis of the sensor, 0.5 to the left, points at 0.4
    scene.poses.sin[i] = std::sin(0.4F - 0.5F);
    for (const LandmarkMode& mode : scene.modes()) mode.gaussian.aa[i] = 1e-3F;
  }
  for (int observation = 0; observation < 5; ++observation)
    update_landmark(scene.observation, scene.poses, 1.0, scene.log_weight(), scene.range());
  for (std::size_t i = 0; i < 16; ++i) {
    EXPECT_EQ(scene.modes()[0].log_weight[i], kDeadMode);  // 0.6 rad off the axis
    EXPECT_EQ(scene.modes()[4].log_weight[i], kDeadMode);
    EXPECT_GT(scene.modes()[2].log_weight[i], -10.0F);
  }
}

/// A ring of five seen from its middle by robots that look along x, in directions so far left of the
/// sensor's axis; half the field of view is 0.6.
ParticleScene make_fan() {
  constexpr float kLeft[]{-0.7F, -0.3F, 0.0F, 0.3F, 0.7F};
  ParticleScene scene = make_scene(kCases[5], 16);
  const LandmarkView& l = scene.observation.landmark;
  for (std::size_t i = 0; i < 16; ++i) {
    scene.poses.x[i] = l.anchor_x[i] + l.offset_x;
    scene.poses.y[i] = l.anchor_y[i] + l.offset_y;
    scene.poses.cos[i] = 1.0F;
    scene.poses.sin[i] = 0.0F;
    for (std::size_t k = 0; k < 5; ++k) {
      scene.gaussian(k).a[i] = 0.5F + kLeft[k];
      scene.gaussian(k).b[i] = 5.0F;
      scene.gaussian(k).aa[i] = 1e-4F;
    }
  }
  return scene;
}

void expect_weights(const ParticleScene& scene, const std::array<double, 5>& expected) {
  for (std::size_t i = 0; i < scene.count(); ++i)
    for (std::size_t k = 0; k < 5; ++k) EXPECT_NEAR(weight_of(scene, k, i), expected[k], 1e-4) << k;
}

TEST(MissModes, WhatWasClearlyInViewLosesWeight) {
  ParticleScene scene = make_fan();
  miss_modes(scene.observation, 0.9, scene.poses, scene.range());
  const double all = 2.0 + 3.0 * 0.1;
  expect_weights(scene, {1.0 / all, 0.1 / all, 0.1 / all, 0.1 / all, 1.0 / all});
}

TEST(MissModes, OutOfReachOrTooNearNothingIsMissed) {
  ParticleScene far = make_fan();
  far.observation.mount.min_rho = 1.0F / 4.9F;
  miss_modes(far.observation, 0.9, far.poses, far.range());
  expect_weights(far, {0.2, 0.2, 0.2, 0.2, 0.2});
  ParticleScene near = make_fan();
  near.observation.mount.min_range = 5.1F;
  miss_modes(near.observation, 0.9, near.poses, near.range());
  expect_weights(near, {0.2, 0.2, 0.2, 0.2, 0.2});
}

TEST(MissModes, WhatCouldHaveBeenNowhereElseStays) {
  ParticleScene scene = make_fan();
  scene.observation.mount.half_view = 4.0F;
  for (int scan = 0; scan < 100; ++scan) miss_modes(scene.observation, 0.9, scene.poses, scene.range());
  expect_weights(scene, {0.2, 0.2, 0.2, 0.2, 0.2});
}

TEST(MissModes, DroppedHypothesesStayDroppedWhateverTheyHold) {
  ParticleScene scene = make_fan();
  weigh_modes(scene);
  for (int scan = 0; scan < 5; ++scan) miss_modes(scene.observation, 0.9, scene.poses, scene.range());
  expect_weights(scene, {0.2, 0.0, 0.0, 0.0, 0.8});
}

TEST(PlaceLandmark, InvertsTheMeasurementOfAPoint) {
  ParticleScene scene = make_scene(kCases[0], 20);
  place_landmark(scene.observation, {}, scene.poses, scene.range());
  const LandmarkMeasurement& z = scene.observation.seen;
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
  const FirstGuess guess = make_guess();
  for (const Case& c : kCases) {
    if (c.form == LandmarkForm::kPoint) continue;
    ParticleScene scene = make_scene(c, 20);
    place_landmark(scene.observation, guess, scene.poses, scene.range());
    const bool is_ray = c.form == LandmarkForm::kRay;
    const LandmarkMeasurement& z = scene.observation.seen;
    for (std::size_t i = 0; i < 20; ++i) {
      const LandmarkView& l = scene.observation.landmark;
      EXPECT_NEAR(l.anchor_x[i] + l.offset_x, scene.poses.x[i], 1e-6F);
      EXPECT_NEAR(l.anchor_y[i] + l.offset_y, scene.poses.y[i], 1e-6F);
      for (std::size_t k = 0; k < c.modes; ++k) {
        // The ray goes where the landmark was seen, directions on a ring count from the sensor's axis.
        const auto& [value, variance, log_weight] = guess.modes[k];
        const double direction = pose_of(scene.poses, i).theta_rad + (is_ray ? 0.4 : 0.5 + value);
        EXPECT_NEAR(scene.gaussian(k).a[i], direction, 1e-5) << c.name;
        EXPECT_EQ(scene.gaussian(k).b[i], is_ray ? value : z.range);
        EXPECT_EQ(scene.gaussian(k).aa[i], is_ray ? z.R_bb : variance);
        EXPECT_EQ(scene.gaussian(k).bb[i], is_ray ? variance : z.R_rr);
        if (c.modes > 1) {
          EXPECT_EQ(scene.modes()[k].log_weight[i], log_weight);
        }
      }
    }
  }
}

}  // namespace
}  // namespace waymark::kernels
