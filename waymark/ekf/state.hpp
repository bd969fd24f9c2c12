#pragma once

#include <memory>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "waymark/core/aligned_array.hpp"
#include "waymark/core/motion.hpp"
#include "waymark/core/parallel.hpp"
#include "waymark/ekf/consistency.hpp"
#include "waymark/ekf/textbook_update.hpp"
#include "waymark/ekf/touched.hpp"
#include "waymark/kernels/layout.hpp"

namespace waymark::ekf {

/// One linearised sighting of landmark `landmark`: nu = z - h, H_pose and H_landmark its Jacobians, R its
/// noise. Only the first `rows` rows and, of H_landmark, the first `dimension()` columns count. `errors` says
/// which lasting errors of the sensor are in z. Where the landmark is relative to another one, `anchor` names
/// that and H_anchor is the Jacobian to it; `second_anchor` likewise, where there is one more.
struct Sighting {
  int landmark = 0;
  int anchor = -1;
  int second_anchor = -1;
  int rows = 2;
  Eigen::Vector2d nu = Eigen::Vector2d::Zero();
  Eigen::Matrix<double, 2, 3> H_pose = Eigen::Matrix<double, 2, 3>::Zero();
  Eigen::Matrix<double, 2, 3> H_landmark = Eigen::Matrix<double, 2, 3>::Zero();
  Eigen::Matrix<double, 2, 3> H_anchor = Eigen::Matrix<double, 2, 3>::Zero();
  Eigen::Matrix<double, 2, 3> H_second_anchor = Eigen::Matrix<double, 2, 3>::Zero();
  Eigen::Matrix2d R = Eigen::Matrix2d::Identity();
  ErrorTerms errors = {};
};

/// What an update did, for a filter that remembers more than the state holds. Views into the state, good
/// until it is next changed.
struct Gain {
  std::size_t rows;  ///< D, measurement rows
  std::size_t ld;    ///< stride of W
  const double* W;   ///< D x n: L^-1 H P, so that P <- P - W^T W
  std::size_t ld_l;  ///< stride of L
  const double* L;   ///< D x D, lower: L L^T = H P H^T + R
  const double* nu;  ///< D: L^-1 nu, so that dx = W^T nu
  const double*
      shear;  ///< n: d of the invariant filter's shear P <- (I + d e_theta^T) P (I + d e_theta^T)^T, or null
  double turn;  ///< change of heading, rad
};

/// The state vector (x, y, theta, lasting errors, landmark 1, landmark 2, ...) with its covariance, and the
/// only code that writes either. Landmarks are 2-D or 3-D; in a 3-D state what stands in the place of a
/// landmark may as well be a pose that the robot once had, or be relative to such a pose. Memory for
/// `capacity` landmarks is taken once; nothing here allocates later.
///
/// Lasting errors are what successive sightings have in common that is neither the robot's nor the map's
/// doing. They come in pairs of independent unit variance at most; what a pair stands for, and how large it
/// is, is for those who use it to say (ErrorTerm::J).
///
/// Only the upper triangle of the covariance is kept (kernels/layout.hpp). Costs with n = 3 + dimension *
/// landmarks: predict O(1), joining the robot's rows up once per update O(n), update of D rows n^2 D flop,
/// add O(n), remove O(n).
class State {
 public:
  State(int dimension, int capacity, Consistency consistency, int threads = 1, int error_pairs = 0);

  [[nodiscard]] int dimension() const { return dimension_; }
  [[nodiscard]] int landmarks() const { return landmarks_; }
  [[nodiscard]] int capacity() const { return capacity_; }
  [[nodiscard]] Consistency consistency() const { return consistency_; }
  /// Most sightings that one update() takes.
  static constexpr int kMaxSightings = 32;

  [[nodiscard]] PoseEstimate pose() const;
  /// Position and covariance of a landmark; z is 0 for 2-D ones. World frame.
  [[nodiscard]] Eigen::Vector3d landmark(int index) const;
  [[nodiscard]] Eigen::Matrix3d landmark_covariance(int index) const;

  /// From now on updates are computed as a textbook has it, for comparison (takes the memory for that). Only
  /// with kStandard; gain() is not to be had.
  void use_textbook_update();
  [[nodiscard]] bool updates_by_textbook() const { return textbook_ != nullptr; }

  /// Where Jacobians are to be taken: the present estimate, or the first ones with kFej.
  [[nodiscard]] Pose2 linearization_pose() const;
  [[nodiscard]] Eigen::Vector3d linearization_landmark(int index) const;

  /// Replaces the belief in the pose; only before anything was predicted or added.
  void set_pose(const PoseEstimate& pose);

  /// Starts from a mean and covariance of (x, y, theta, landmarks) as mean() and covariance() give them; only
  /// before anything was added. The lasting errors stay what they are, independent of all that.
  void load(const Eigen::Ref<const Eigen::VectorXd>& mean, const Eigen::Ref<const Eigen::MatrixXd>& P);

  /// From now on no update touches the landmarks, neither their mean nor their covariance: what they are
  /// unsure of is considered (Schmidt 1966), an update costs n D (head + D) flop. Not with kInvariant.
  void hold_landmarks();

  /// Puts the robot somewhere else: a belief in its pose that is independent of everything.
  void place_robot(const PoseEstimate& pose);

  /// Moves the robot: P_rr <- F P_rr F^T + G Q G^T at once; P_rm <- Phi P_rm when it is next needed. Where
  /// `errors` say how the motion's increment depends on lasting errors, d(x, y, theta)/derrors, P_rm is
  /// brought up to date now: O(n).
  void predict(const Motion& motion, const ErrorTerms& errors = {});

  /// Expected values of a pair of lasting errors; zero at first, and certainly so.
  [[nodiscard]] Eigen::Vector2d errors(int pair) const;
  /// Covariance of a pair with another, or with itself.
  [[nodiscard]] Eigen::Matrix2d errors_covariance(int pair, int other) const;
  /// What the state expects of the errors in a sighting.
  [[nodiscard]] Eigen::Vector2d expected(const ErrorTerms& terms) const;
  /// Lets a pair drift: e <- rho e + N(0, 1 - rho^2). With rho = 0 it forgets all and has unit variance.
  /// O(n).
  void relax_errors(int pair, double rho);

  /// S = H P H^T + R of one sighting (its leading rows x rows part counts), from marginals only: O(1).
  [[nodiscard]] Eigen::Matrix2d innovation_covariance(const Sighting& sighting) const;

  /// H_a P H_b^T: what two sightings have in common besides their noise. O(1).
  [[nodiscard]] Eigen::Matrix2d common_covariance(const Sighting& a, const Sighting& b) const;

  /// C = P(pose, :) H^T of one sighting: how what it measures goes with (x, y, theta). O(1).
  [[nodiscard]] Eigen::Matrix<double, 3, 2> pose_correlation(const Sighting& sighting) const;

  /// Exact update with all sightings at once (Vincke et al. 2012, equations 10 to 12, as P -= W^T W with
  /// W = L^-1 H P, L L^T = S): at most kMaxSightings. False, and nothing changed, if S is not positive
  /// definite.
  [[nodiscard]] bool update(std::span<const Sighting> sightings);

  /// The same in two steps, for those who want to see where the update would go and perhaps linearise there:
  /// propose() finds it, accept() goes there. What is proposed is dropped by any other change.
  [[nodiscard]] bool propose(std::span<const Sighting> sightings);
  void accept();
  [[nodiscard]] Pose2 proposed_pose() const;
  [[nodiscard]] Eigen::Vector3d proposed_landmark(int index) const;
  [[nodiscard]] Eigen::Vector2d proposed_expected(const ErrorTerms& terms) const;
  /// H dx: what the proposal explains of a sighting's innovation, if all were linear.
  [[nodiscard]] Eigen::Vector2d explained(const Sighting& sighting) const;
  /// A sighting that was linearised at what is proposed (nu = z - h there, ordinary Jacobians), as one of the
  /// state as it still is: the step of Gauss and Newton, nu + H dx, with H to the increments dx that the
  /// state is moved by.
  [[nodiscard]] Sighting moved_back(const Sighting& sighting) const;

  /// Appends a landmark at `position` = g(pose, z): G_pose is dg/d(x, y, theta), `noise` is G_z R G_z^T; only
  /// their leading `dimension()` rows count; `errors` as dg/derrors. Returns its index. The map must not be
  /// full.
  int add(const Eigen::Vector3d& position, const Eigen::Matrix3d& G_pose, const Eigen::Matrix3d& noise,
          const ErrorTerms& errors = {});

  /// Appends a landmark that was estimated elsewhere: `cross` holds its covariance with the whole state so
  /// far, one row of n values per coordinate, `ld` apart. `first` is its first estimate. Returns its index.
  /// The map must not be full.
  int insert(const Eigen::Vector3d& position, const Eigen::Vector3d& first, const double* cross,
             std::size_t ld, const Eigen::Matrix3d& covariance);

  /// Appends the robot's present pose (x, y, theta), so that something seen from here can be relative to it.
  /// 3-D states only; the map must not be full.
  int add_pose();

  /// Appends values that hold relative to another landmark, so that no turn of the world changes them.
  /// `errors` as dg/derrors.
  int add_relative(const Eigen::Vector3d& values, const Eigen::Matrix3d& noise,
                   const ErrorTerms& errors = {});

  /// What a relative landmark and the pose it is relative to say together, as an ordinary landmark in the
  /// place of the former: position = g(anchor, landmark) with its Jacobians.
  void make_absolute(int landmark, int anchor, const Eigen::Vector3d& position,
                     const Eigen::Matrix3d& G_anchor, const Eigen::Matrix3d& G_landmark);

  /// Makes a landmark less sure by itself: adds to its own covariance. O(1).
  void loosen(int index, const Eigen::Matrix3d& covariance);

  /// Its lower triangle counts.
  using JointCovariance =
      Eigen::Ref<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>, 0,
                 Eigen::OuterStride<>>;

  /// S of all these sightings together, lower triangle, and its size: for those who ask which of them agree.
  /// Drops what was proposed. A view, good until the next call that changes or proposes anything.
  [[nodiscard]] JointCovariance joint_innovation_covariance(std::span<const Sighting> sightings);

  /// Marginalises a landmark out; the last one takes its index.
  void remove(int index);

  /// Row or column of a landmark in mean and covariance.
  [[nodiscard]] std::size_t offset(int index) const {
    return head_ + static_cast<std::size_t>(index * dimension_);
  }
  /// Rows before the first landmark: the robot's and those of the lasting errors.
  [[nodiscard]] std::size_t head() const { return head_; }
  /// The rows of the state that the first `rows` rows of a sighting depend on.
  [[nodiscard]] Touched touched(const Sighting& sighting, int rows) const;
  /// n
  [[nodiscard]] std::size_t size() const { return offset(landmarks_); }
  /// One entry of the covariance.
  [[nodiscard]] double covariance(std::size_t i, std::size_t j) const;
  /// First estimate of a landmark.
  [[nodiscard]] Eigen::Vector3d first_estimate(int index) const { return point(first_, index); }

  /// What the last successful update() did; nothing else may have happened since.
  [[nodiscard]] Gain gain() const;

  /// P_rm <- Phi P_rm as far as it is due. Returns phi of Phi = [I, phi; 0, 1]: zero if nothing was due.
  /// Every operation that needs it does it by itself.
  Eigen::Vector2d join_robot_rows();
  /// What it would return.
  [[nodiscard]] Eigen::Vector2d pending() const { return pending_phi_; }

  /// Mean and symmetric covariance of robot and landmarks; allocates.
  [[nodiscard]] Eigen::VectorXd mean() const;
  [[nodiscard]] Eigen::MatrixXd covariance() const;

 private:
  using Buffer = AlignedArray<double>;

  [[nodiscard]] Eigen::Vector3d point(const Buffer& buffer, int index) const;
  [[nodiscard]] static Eigen::Vector2d error_part(const ErrorTerms& terms, const Buffer& values);
  [[nodiscard]] double P(std::size_t i, std::size_t j) const {
    return i <= j ? P_[i * ld_ + j] : P_[j * ld_ + i];
  }
  [[nodiscard]] std::size_t place(int i) const;
  void spread_errors(const Eigen::Matrix3d& G, const ErrorTerms& errors);

  void write_pose(const PoseEstimate& pose);
  std::size_t project(std::span<const Sighting> sightings);
  void form_innovation_covariance(std::span<const Sighting> sightings, int rows);
  [[nodiscard]] bool factorize(int rows);
  [[nodiscard]] bool propose_by_textbook(std::span<const Sighting> sightings);
  void correct_covariance_by_textbook();
  void apply_additively();
  void apply_invariantly();
  [[nodiscard]] Eigen::Matrix2d increment_jacobian() const;
  void prepare_shear();
  void correct_covariance(bool shear);
  /// Rows of the mean and the covariance that an update changes.
  [[nodiscard]] std::size_t updated_rows() const { return held_ ? head_ : size(); }

  int dimension_;
  int capacity_;
  Consistency consistency_;
  std::size_t head_;
  int landmarks_ = 0;
  bool held_ = false;
  std::size_t ld_;

  Buffer x_;                    // n: the mean
  Buffer first_;                // n: first estimates of the landmarks (kFej)
  std::vector<char> relative_;  // by landmark: turns of the world leave it alone
  Buffer P_;                    // n x n, upper triangle
  Buffer W_;                    // D x n: H P, then L^-1 H P
  Buffer dx_;                   // n: K nu
  Buffer shear_d_;              // n: d of the shear
  Buffer shear_e_;              // n: c + c_th/2 d
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> S_;  // D x D, L after factorize()
  Eigen::VectorXd nu_;                                                        // D, then L^-1 nu
  std::size_t rows_ = 0;                                                      // D of the last proposal

  // P_rm is due Phi = [I, phi; 0, 1] with phi the displacement (turned by 90 degrees) since it was last
  // joined.
  Eigen::Vector2d pending_phi_ = Eigen::Vector2d::Zero();
  bool pending_ = false;
  Pose2 linearization_pose_;  // the predicted pose, x_{k|k-1}

  ThreadTeam team_;
  std::unique_ptr<TextbookUpdate> textbook_;  // where that is used
};

}  // namespace waymark::ekf
