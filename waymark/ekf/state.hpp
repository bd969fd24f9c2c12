#pragma once

#include <span>

#include <Eigen/Core>

#include "waymark/core/motion.hpp"
#include "waymark/ekf/belief.hpp"
#include "waymark/ekf/proposal.hpp"
#include "waymark/ekf/shear.hpp"
#include "waymark/ekf/update.hpp"

namespace waymark::ekf {

/// The state vector (x, y, theta, biases, landmark 1, landmark 2, ...) with its covariance, and the
/// only code that writes either. Landmarks are 2-D or 3-D; in a 3-D state what stands in the place of a
/// landmark may as well be a pose that the robot once had, or be relative to such a pose. Memory for
/// `capacity` landmarks is taken once; nothing here allocates later.
///
/// Biases are what successive observations have in common that is neither the robot's nor the map's
/// doing. They come in pairs of independent unit variance at most; what a pair stands for, and how large it
/// is, is for those who use it to say (BiasTerm::J).
///
/// What it believes is asked of its base, and what it proposes of proposal(). Costs with n = 3 + dimension *
/// landmarks: predict O(1), joining the robot's rows up once per update O(n), update of D rows n^2 D flop,
/// add O(n), remove O(n).
class State : public Belief {
 public:
  State(int dimension, int capacity, Consistency consistency, int threads = 1, int bias_pairs = 0);

  [[nodiscard]] int capacity() const { return static_cast<int>(relative_.size()); }
  /// Most observations that one update() takes.
  static constexpr int kMaxObservations = Update::kMaxObservations;

  /// Starts from a mean and covariance of (x, y, theta, landmarks) as mean() and covariance() give them; only
  /// before anything was added. The biases stay what they are, independent of all that.
  void load(const Eigen::Ref<const Eigen::VectorXd>& mean, const Eigen::Ref<const Eigen::MatrixXd>& P);

  /// Puts the robot somewhere else: a belief in its pose that is independent of everything.
  void place_robot(const PoseEstimate& pose);

  /// Moves the robot: P_rr <- F P_rr F^T + G Q G^T at once; P_rm <- Phi P_rm when it is next needed. Where
  /// `errors` say how the motion's increment depends on biases, d(x, y, theta)/derrors, P_rm is
  /// brought up to date now: O(n).
  void predict(const Motion& motion, const BiasTerms& errors = {});

  /// Lets a pair of biases drift: e <- rho e + N(0, 1 - rho^2). With rho = 0 it forgets all and has
  /// unit variance. O(n).
  void propagate_bias(int pair, double rho);

  /// Exact update with all observations at once: at most kMaxObservations. False, and nothing changed, if S
  /// is not positive definite.
  [[nodiscard]] bool update(std::span<const LinearizedObservation> linearizations);

  /// The same in two steps: propose() finds where to go, which proposal() says, and accept() goes there. What
  /// is proposed is dropped by any other change.
  [[nodiscard]] bool propose(std::span<const LinearizedObservation> linearizations);
  [[nodiscard]] Proposal proposal() const { return {*this, update_.dx()}; }
  void accept();
  /// What accept() did; nothing else may have happened since.
  [[nodiscard]] Gain gain() const;

  /// From now on updates are computed as a textbook has it, for comparison (takes the memory for that). Only
  /// with kStandard; gain() is not to be had.
  void use_textbook_update();
  /// From now on no update touches the landmarks, neither their mean nor their covariance: what they are
  /// unsure of is considered (Schmidt 1966), an update costs n D (head + D) flop. Not with kInvariant.
  void hold_landmarks();

  /// S of all these observations together, lower triangle, and its size: for those who ask which of them
  /// agree. Drops what was proposed. A view, good until the next call that changes or proposes anything.
  [[nodiscard]] JointCovariance joint_innovation_covariance(
      std::span<const LinearizedObservation> linearizations);

  /// Appends a landmark at `position` = g(pose, z): G_pose is dg/d(x, y, theta), `noise` is G_z R G_z^T; only
  /// their leading `dimension()` rows count; `errors` as dg/derrors. Returns its index. The map must not be
  /// full.
  int add(const Eigen::Vector3d& position, const Eigen::Matrix3d& G_pose, const Eigen::Matrix3d& noise,
          const BiasTerms& errors = {});

  /// Appends a landmark that was estimated elsewhere, first at `first`. Returns its index. The map must not
  /// be full.
  int insert(const Eigen::Vector3d& position, const Eigen::Vector3d& first, const NewRows& rows);

  /// Appends the robot's present pose (x, y, theta), so that something seen from here can be relative to it.
  /// 3-D states only; the map must not be full.
  int add_pose();

  /// Appends values that hold relative to another landmark, so that no turn of the world changes them.
  int add_relative(const Eigen::Vector3d& values, const Eigen::Matrix3d& noise);

  /// What a relative landmark and the pose it is relative to say together, as an ordinary landmark in the
  /// place of the former: position = g(anchor, landmark) with its Jacobians.
  void make_absolute(int landmark, int anchor, const Eigen::Vector3d& position,
                     const Eigen::Matrix3d& G_anchor, const Eigen::Matrix3d& G_landmark);

  /// Makes a landmark less sure by itself: adds to its own covariance. O(1).
  void inflate(int index, const Eigen::Matrix3d& covariance);

  /// Marginalises a landmark out; the last one takes its index.
  void remove(int index);

  /// What motions left to do for the robot's rows of the covariance, done now: see Covariance. Every
  /// operation that needs it does it by itself.
  Eigen::Vector2d propagate_cross_covariance() { return P_.propagate_cross_covariance(); }
  [[nodiscard]] const Eigen::Vector2d& deferred() const { return P_.deferred(); }

 private:
  void write_pose(const Pose2& pose);

  Update update_;
  Shear shear_;
};

}  // namespace waymark::ekf
