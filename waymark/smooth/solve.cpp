#include "waymark/smooth/solve.hpp"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "waymark/smooth/factors.hpp"
#include "waymark/smooth/selected_inverse.hpp"

namespace waymark::smooth {
namespace {

// Odometry that claims to be better than this in some direction is not.
constexpr double kMinIntervalSigma_m = 1e-4;
constexpr double kMinIntervalSigma_rad = 1e-5;
constexpr double kAnyWeight = 1e9;
constexpr int kMaxIterations = 50;

/// Student-t: the cost of a squared error, and its weight.
struct Robust {
  double dof;
  [[nodiscard]] double cost(double squared, int dimension) const {
    return (dof + dimension) * std::log1p(squared / dof);
  }
  [[nodiscard]] double weight(double squared, int dimension) const {
    return (dof + dimension) / (dof + squared);
  }
};

/// Where the variables of a graph stand in the vector of all. The first pose is none.
class Layout {
 public:
  Layout(const Graph& graph, const Estimate& estimate)
      : landmarks_(3 * (std::ssize(estimate.poses) - 1)),
        calibration_(landmarks_ + 2 * std::ssize(estimate.landmarks)),
        size_(calibration_) {
    for (Eigen::Index i = 0; i < kCalibrationSize; ++i)
      if (graph.calibration_sigmas[i] > 0.0) estimated_.push_back(i);
    size_ += std::ssize(estimated_);
  }

  [[nodiscard]] static Eigen::Index pose(std::size_t index) {
    return 3 * (static_cast<Eigen::Index>(index) - 1);
  }
  [[nodiscard]] Eigen::Index landmark(std::size_t index) const {
    return landmarks_ + 2 * static_cast<Eigen::Index>(index);
  }
  [[nodiscard]] Eigen::Index calibration() const { return calibration_; }
  [[nodiscard]] Eigen::Index size() const { return size_; }
  /// Which parts of the calibration are variables.
  [[nodiscard]] const std::vector<Eigen::Index>& estimated() const { return estimated_; }

 private:
  Eigen::Index landmarks_;
  Eigen::Index calibration_;
  Eigen::Index size_;
  std::vector<Eigen::Index> estimated_;
};

/// Sums up J^T J and J^T r of all factors.
class NormalEquations {
 public:
  explicit NormalEquations(const Layout& layout)
      : layout_(layout), g_(Eigen::VectorXd::Zero(layout.size())) {}

  /// A block of columns of a factor's Jacobian; `at` < 0: it is no variable.
  template <int Rows>
  struct Block {
    Eigen::Index at;
    Eigen::Matrix<double, Rows, Eigen::Dynamic, Eigen::ColMajor, Rows, kCalibrationSize> J;
  };

  /// Blocks in any order.
  template <int Rows>
  void add(double weight, const Eigen::Matrix<double, Rows, 1>& residual,
           std::initializer_list<Block<Rows>> blocks) {
    for (const Block<Rows>& row : blocks) {
      if (row.at < 0) continue;
      const auto Jt = (weight * row.J.transpose()).eval();
      for (Eigen::Index i = 0; i < Jt.rows(); ++i) {
        double sum = Jt(i, 0) * residual[0];
        for (Eigen::Index k = 1; k < Rows; ++k) sum += Jt(i, k) * residual[k];
        g_[row.at + i] += sum;
      }
      for (const Block<Rows>& column : blocks) add_product(row.at, Jt, column);
    }
  }

  /// A prior on one variable.
  void add_prior(Eigen::Index at, double residual, double information) {
    entries_.emplace_back(static_cast<int>(at), static_cast<int>(at), information);
    g_[at] += information * residual;
  }

  [[nodiscard]] SparseMatrix H() const {
    SparseMatrix H(layout_.size(), layout_.size());
    H.setFromTriplets(entries_.begin(), entries_.end());
    return H;
  }
  [[nodiscard]] const Eigen::VectorXd& g() const { return g_; }

  /// The columns of a calibration that are variables.
  template <int Rows>
  [[nodiscard]] Block<Rows> calibration(const Eigen::Matrix<double, Rows, kCalibrationSize>& J) const {
    return {layout_.calibration(), J(Eigen::all, layout_.estimated())};
  }

 private:
  template <class Transposed, class Column>
  void add_product(Eigen::Index row, const Transposed& Jt, const Column& column) {
    if (column.at < 0 || column.at > row) return;
    for (Eigen::Index j = 0; j < column.J.cols(); ++j)
      for (Eigen::Index i = column.at == row ? j : 0; i < Jt.rows(); ++i) {
        double product = Jt(i, 0) * column.J(0, j);
        for (Eigen::Index k = 1; k < Jt.cols(); ++k) product += Jt(i, k) * column.J(k, j);
        entries_.emplace_back(static_cast<int>(row + i), static_cast<int>(column.at + j), product);
      }
  }

  const Layout& layout_;
  std::vector<Eigen::Triplet<double>> entries_;
  Eigen::VectorXd g_;
};

/// An estimate on its way to the optimum.
class Solver {
 public:
  Solver(const Graph& graph, Estimate start, const SolveOptions& options)
      : graph_(graph),
        estimate_(std::move(start)),
        landmarks_before_(estimate_.landmarks),
        options_(options),
        robust_{options.robust_dof},
        layout_(graph, estimate_) {
    for (const KeyframeInterval& interval : graph.intervals) {
      Eigen::Matrix3d Q = interval.covariance;
      const Eigen::Vector3d least(kMinIntervalSigma_m, kMinIntervalSigma_m, kMinIntervalSigma_rad);
      Q.diagonal() += least.cwiseAbs2();
      interval_information_.emplace_back(Q.llt().solve(Eigen::Matrix3d::Identity()));
    }
  }

  Solution run() {
    Solution solution;
    solution.cost_before = solution.cost = cost(estimate_);
    for (; solution.iterations < kMaxIterations && !solution.converged; ++solution.iterations)
      solution.converged = !step(solution.cost);
    add_covariances(solution);
    solution.estimate = estimate_;
    return solution;
  }

 private:
  /// Goes one step down; false: there is no way down that is worth it.
  bool step(double& cost_now) {
    constexpr double kMaxDamping = 1e8;
    constexpr double kWorthIt = 1e-6;
    const NormalEquations equations = linearize();
    const SparseMatrix H = equations.H();
    for (; damping_ < kMaxDamping; damping_ *= 10.0) {
      if (!factorize(H, damping_)) continue;
      Estimate moved = moved_by(-factor_.solve(equations.g()));
      const double cost_there = cost(moved);
      if (!(cost_there < cost_now)) continue;
      const bool worth_it = cost_now - cost_there > kWorthIt * cost_now;
      estimate_ = std::move(moved);
      cost_now = cost_there;
      damping_ = std::max(1e-12, 0.1 * damping_);
      return worth_it;
    }
    return false;
  }

  bool factorize(SparseMatrix H, double damping) {
    H.diagonal() *= 1.0 + damping;
    if (!analyzed_) factor_.analyzePattern(H);
    analyzed_ = true;
    factor_.factorize(H);
    return factor_.info() == Eigen::Success && (factor_.vectorD().array() > 0.0).all();
  }

  /// `max_weight`: what a measurement counts at most, in measurements with the stated noise.
  [[nodiscard]] NormalEquations linearize(double max_weight = kAnyWeight) const {
    NormalEquations equations(layout_);
    for (std::size_t i = 0; i < graph_.intervals.size(); ++i) add_interval(i, max_weight, equations);
    for (const ObservationEdge& observation : graph_.observations)
      add_observation(observation, max_weight, equations);
    for (std::size_t i = 0; i < landmarks_before_.size(); ++i) add_prior(i, equations);
    for (std::size_t i = 0; i < layout_.estimated().size(); ++i) {
      const Eigen::Index which = layout_.estimated()[i];
      const double sigma = graph_.calibration_sigmas[which];
      equations.add_prior(layout_.calibration() + static_cast<Eigen::Index>(i),
                          estimate_.calibration[which] - graph_.calibration_mean[which],
                          1.0 / (sigma * sigma));
    }
    return equations;
  }

  void add_prior(std::size_t landmark, NormalEquations& equations) const {
    const Eigen::Vector2d away_m = estimate_.landmarks[landmark] - landmarks_before_[landmark];
    const double information = 1.0 / (graph_.landmark_sigma_m * graph_.landmark_sigma_m);
    for (Eigen::Index axis = 0; axis < 2; ++axis)
      equations.add_prior(layout_.landmark(landmark) + axis, away_m[axis], information);
  }

  void add_interval(std::size_t i, double max_weight, NormalEquations& equations) const {
    const OdometryFactor f = factor_of_interval(estimate_, i);
    const Eigen::Matrix3d& information = interval_information_[i];
    const double weight = std::min(max_weight, robust_.weight(f.residual.dot(information * f.residual), 3));
    const Eigen::Matrix3d U = information.llt().matrixU();
    equations.add<3>(weight, U * f.residual,
                     {{Layout::pose(i), U * f.J_before},
                      {Layout::pose(i + 1), U * f.J_after},
                      equations.calibration<3>(U * f.J_calibration)});
  }

  void add_observation(const ObservationEdge& observation, double max_weight,
                       NormalEquations& equations) const {
    const ObservationFactor f = factor_of(estimate_, observation);
    if (f.dof == 0) return;
    const double weight = std::min(max_weight, robust_.weight(f.residual.squaredNorm(), f.dof));
    equations.add<2>(weight, f.residual,
                     {{Layout::pose(static_cast<std::size_t>(observation.pose)), f.J_pose},
                      {layout_.landmark(static_cast<std::size_t>(observation.landmark)), f.J_landmark},
                      equations.calibration<2>(f.J_calibration)});
  }

  [[nodiscard]] OdometryFactor factor_of_interval(const Estimate& at, std::size_t i) const {
    const OdometryFactor factor =
        linearize_odometry(at.poses[i], at.poses[i + 1], motion_of(graph_.intervals[i], at.calibration));
    return whiten_by_error_source(factor, graph_.intervals[i].measured_part, at.calibration);
  }

  [[nodiscard]] ObservationFactor factor_of(const Estimate& at, const ObservationEdge& observation) const {
    return linearize_observation(
        observation, at.poses[static_cast<std::size_t>(observation.pose)], graph_.T_robot_sensor,
        at.landmarks[static_cast<std::size_t>(observation.landmark)], at.calibration);
  }

  [[nodiscard]] double cost(const Estimate& at) const {
    double sum = 0.0;
    for (std::size_t i = 0; i < graph_.intervals.size(); ++i) {
      const Eigen::Vector3d residual = factor_of_interval(at, i).residual;
      sum += robust_.cost(residual.dot(interval_information_[i] * residual), 3);
    }
    for (const ObservationEdge& observation : graph_.observations) {
      const ObservationFactor f = factor_of(at, observation);
      sum += robust_.cost(f.residual.squaredNorm(), f.dof);
    }
    for (std::size_t i = 0; i < landmarks_before_.size(); ++i)
      sum += (at.landmarks[i] - landmarks_before_[i]).squaredNorm() /
             (graph_.landmark_sigma_m * graph_.landmark_sigma_m);
    for (const Eigen::Index i : layout_.estimated())
      sum += std::pow((at.calibration[i] - graph_.calibration_mean[i]) / graph_.calibration_sigmas[i], 2);
    return sum;
  }

  [[nodiscard]] Estimate moved_by(const Eigen::VectorXd& delta) const {
    Estimate moved = estimate_;
    for (std::size_t i = 1; i < moved.poses.size(); ++i) {
      const auto d = delta.segment<3>(Layout::pose(i));
      Pose2& pose = moved.poses[i];
      pose = {pose.x_m + d[0], pose.y_m + d[1], wrap_angle(pose.theta_rad + d[2])};
    }
    for (std::size_t i = 0; i < moved.landmarks.size(); ++i)
      moved.landmarks[i] += delta.segment<2>(layout_.landmark(i));
    moved.calibration(layout_.estimated()) += delta.tail(std::ssize(layout_.estimated()));
    return moved;
  }

  void add_covariances(Solution& solution) {
    // Small errors have weights above 1 and yet tell no more than what has the stated noise.
    if (layout_.size() == 0 || !factorize(linearize(1.0).H(), 0.0)) return;
    add_calibration_covariance(solution);
    const auto P = SelectedInverse::compute(factor_, options_.max_covariance_work);
    if (!P) return;
    solution.pose_covariances.emplace_back(Eigen::Matrix3d::Zero());
    for (std::size_t i = 1; i < estimate_.poses.size(); ++i)
      solution.pose_covariances.push_back(marginal<3>(*P, Layout::pose(i)));
    for (std::size_t i = 0; i < estimate_.landmarks.size(); ++i)
      solution.landmark_covariances.push_back(marginal<2>(*P, layout_.landmark(i)));
    for (const ObservationEdge& observation : graph_.observations)
      solution.observation_residuals.push_back(residual_of(observation, *P));
    for (std::size_t i = 0; i < graph_.intervals.size(); ++i)
      solution.interval_residuals.push_back(residual_of_interval(i, *P));
  }

  /// All variables that an observation depends on are joined in the pattern of the inverse.
  [[nodiscard]] ObservationResidual residual_of(const ObservationEdge& observation,
                                                const SelectedInverse& P) const {
    const ObservationFactor f = factor_of(estimate_, observation);
    Eigen::Matrix<double, 2, Eigen::Dynamic> J(2, 5 + std::ssize(layout_.estimated()));
    J << f.J_pose, f.J_landmark, f.J_calibration(Eigen::all, layout_.estimated());
    const Eigen::Matrix2d followed = followed_by(
        P, J,
        with_calibration({{Layout::pose(static_cast<std::size_t>(observation.pose)), 3},
                          {layout_.landmark(static_cast<std::size_t>(observation.landmark)), 2}}));
    const Eigen::Vector2d stated = observation.covariance.diagonal();
    if (f.dof < 2) return {std::sqrt(stated[0]) * f.residual, stated[0] * followed.diagonal(), stated};
    const Eigen::Matrix2d root = observation.covariance.llt().matrixL();
    return {root * f.residual, (root * followed * root.transpose()).diagonal(), stated};
  }

  [[nodiscard]] IntervalResidual residual_of_interval(std::size_t i, const SelectedInverse& P) const {
    const OdometryFactor f = factor_of_interval(estimate_, i);
    Eigen::Matrix<double, 3, Eigen::Dynamic> J(3, 6 + std::ssize(layout_.estimated()));
    J << f.J_before, f.J_after, f.J_calibration(Eigen::all, layout_.estimated());
    return {f.residual,
            followed_by(P, J, with_calibration({{Layout::pose(i), 3}, {Layout::pose(i + 1), 3}})).diagonal(),
            interval_information_[i].inverse().diagonal()};
  }

  /// Where stretches of variables (the first of each, how many) and the calibration stand.
  [[nodiscard]] std::vector<Eigen::Index> with_calibration(
      std::initializer_list<std::pair<Eigen::Index, Eigen::Index>> stretches) const {
    std::vector<Eigen::Index> at;
    const auto add = [&at](Eigen::Index first, Eigen::Index count) {
      for (Eigen::Index i = 0; i < count; ++i) at.push_back(first < 0 ? -1 : first + i);
    };
    for (const auto& [first, count] : stretches) add(first, count);
    add(layout_.calibration(), std::ssize(layout_.estimated()));
    return at;
  }

  /// J P J^T; columns at < 0 are no variables.
  template <int Rows>
  static Eigen::Matrix<double, Rows, Rows> followed_by(const SelectedInverse& P,
                                                       const Eigen::Matrix<double, Rows, Eigen::Dynamic>& J,
                                                       const std::vector<Eigen::Index>& at) {
    Eigen::Matrix<double, Rows, Rows> followed = Eigen::Matrix<double, Rows, Rows>::Zero();
    for (std::size_t i = 0; i < at.size(); ++i)
      for (std::size_t j = 0; j < at.size(); ++j)
        if (at[i] >= 0 && at[j] >= 0)
          followed += J.col(static_cast<Eigen::Index>(i)) * P(at[i], at[j]) *
                      J.col(static_cast<Eigen::Index>(j)).transpose();
    return followed;
  }

  /// Its columns are cheap, however large the rest is.
  void add_calibration_covariance(Solution& solution) const {
    const std::vector<Eigen::Index>& estimated = layout_.estimated();
    for (std::size_t i = 0; i < estimated.size(); ++i) {
      const Eigen::Index column = layout_.calibration() + static_cast<Eigen::Index>(i);
      const Eigen::VectorXd P = factor_.solve(Eigen::VectorXd::Unit(layout_.size(), column));
      solution.calibration_covariance(estimated, estimated[i]) = P.tail(std::ssize(estimated));
    }
    solution.calibration_sigmas = solution.calibration_covariance.diagonal().cwiseSqrt();
  }

  template <int Size>
  static Eigen::Matrix<double, Size, Size> marginal(const SelectedInverse& P, Eigen::Index at) {
    Eigen::Matrix<double, Size, Size> block;
    for (Eigen::Index i = 0; i < Size; ++i)
      for (Eigen::Index j = 0; j < Size; ++j) block(i, j) = P(at + i, at + j);
    return block;
  }

  const Graph& graph_;
  Estimate estimate_;
  std::vector<Eigen::Vector2d> landmarks_before_;
  SolveOptions options_;
  Robust robust_;
  Layout layout_;
  std::vector<Eigen::Matrix3d> interval_information_;
  SparseCholesky factor_;
  bool analyzed_ = false;
  double damping_ = 1e-6;
};

}  // namespace

CalibratedMotion motion_of(const KeyframeInterval& interval, const Calibration& calibration) {
  CalibratedMotion motion;
  for (const OdometryStep& step : interval.steps)
    motion = compose(motion, calibrate(step.increment, step.dt_s, calibration));
  return motion;
}

Solution solve(const Graph& graph, Estimate start, const SolveOptions& options) {
  return Solver(graph, std::move(start), options).run();
}

}  // namespace waymark::smooth
