#pragma once

#include <span>

#include <Eigen/Core>

#include "waymark/core/motion.hpp"
#include "waymark/core/observation.hpp"

namespace waymark::app {

/// EKF-SLAM as one writes it with Eigen, identities known and numbered from 0: what our own steps are
/// compared with.
class PlainEkf {
 public:
  enum class Form {
    kTextbook,    ///< dense H, P = (I - K H) P: O(n^3)
    kRankUpdate,  ///< H P from the non-zero columns, one triangle of P, Eigen's rankUpdate: n^2 D flop, as
                  ///< ours
  };

  PlainEkf(Form form, const Motion& start, std::span<const Observation> all_landmarks);

  void step(const Motion& motion, std::span<const Observation> observations);
  [[nodiscard]] Pose2 pose() const { return {x_[0], x_[1], x_[2]}; }

 private:
  using Matrix = Eigen::MatrixXd;
  using Vector = Eigen::VectorXd;
  struct Row;

  void add(const Observation& observation);
  void predict(const Motion& motion);
  [[nodiscard]] Row linearize(const Observation& observation) const;
  void update_textbook(std::span<const Observation> observations);
  void update_by_rank(std::span<const Observation> observations);
  [[nodiscard]] Vector column(Eigen::Index j) const;
  void move(const Vector& dx);

  Form form_;
  Vector x_ = Vector::Zero(3);
  Matrix P_ = Matrix::Zero(3, 3);
};

}  // namespace waymark::app
