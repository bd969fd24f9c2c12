#include "waymark/ekf/update.hpp"

#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <gtest/gtest.h>

#include "support/allocation_counter.hpp"
#include "support/matrix_near.hpp"
#include "support/poses.hpp"
#include "waymark/core/random.hpp"

#include "random_observations.hpp"

namespace waymark::ekf {
namespace {

using test::matrix_near;
using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
using Panel = Eigen::Map<const RowMajor, 0, Eigen::OuterStride<>>;

/// Four 2-D landmarks and a pair of biases, observed three times.
class UpdateTest : public testing::Test {
 protected:
  static constexpr int kSize = 13;

  UpdateTest() : before_(test::random_covariance<kSize>(random_)), P_(kSize, kSize), update_(kSize, 1) {
    for (std::size_t i = 0; i < kSize; ++i)
      for (std::size_t j = i; j < kSize; ++j)
        P_.row(i)[j] = before_(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
    for (const int landmark : {0, 3, 1})
      linearizations_.push_back(test::random_observation(random_, landmark, 2, 1));
    linearizations_[0].rows = 2;
    linearizations_[1].rows = 1;
    for (const LinearizedObservation& s : linearizations_) rows_ += s.rows;
    H_.resize(rows_, kSize);
    R_.setZero(rows_, rows_);
    nu_.resize(rows_);
    int row = 0;
    for (const LinearizedObservation& s : linearizations_) {
      H_.middleRows(row, s.rows) = test::dense(layout_.jacobian(s, s.rows), kSize);
      R_.block(row, row, s.rows, s.rows) = s.R.topLeftCorner(s.rows, s.rows);
      nu_.segment(row, s.rows) = s.nu.head(s.rows);
      row += s.rows;
    }
    S_ = H_ * before_ * H_.transpose() + R_;
    K_ = before_ * H_.transpose() * S_.inverse();
  }

  [[nodiscard]] Eigen::MatrixXd now() const {
    return Eigen::MatrixXd::NullaryExpr(kSize, kSize, [this](Eigen::Index i, Eigen::Index j) {
      return P_(static_cast<std::size_t>(i), static_cast<std::size_t>(j));
    });
  }
  [[nodiscard]] Eigen::VectorXd dx() const { return Eigen::Map<const Eigen::VectorXd>(update_.dx(), kSize); }

  RandomStream random_{1, StreamPurpose::kWorld};
  StateLayout layout_{2, bias_offset(1), 4};
  Eigen::MatrixXd before_;
  Covariance P_;
  Update update_;
  std::vector<LinearizedObservation> linearizations_;
  int rows_ = 0;
  Eigen::MatrixXd H_, R_, S_, K_;
  Eigen::VectorXd nu_;
};

TEST_F(UpdateTest, IsThatOfTheArticle) {
  ASSERT_TRUE(update_.propose(P_, layout_, linearizations_));
  EXPECT_TRUE(matrix_near(dx(), Eigen::VectorXd(K_ * nu_), 1e-11));
  EXPECT_EQ(now(), before_);
  update_.correct(P_, nullptr);
  EXPECT_TRUE(matrix_near(now(), Eigen::MatrixXd(before_ - K_ * H_ * before_), 1e-11));
}

TEST_F(UpdateTest, TellsWhatItDid) {
  ASSERT_TRUE(update_.propose(P_, layout_, linearizations_));
  update_.correct(P_, nullptr);
  const Gain gain = update_.gain();
  ASSERT_EQ(static_cast<int>(gain.rows), rows_);
  const Panel W(gain.W, rows_, kSize, Eigen::OuterStride<>(static_cast<Eigen::Index>(gain.ld)));
  const Panel stored(gain.L, rows_, rows_, Eigen::OuterStride<>(static_cast<Eigen::Index>(gain.ld_l)));
  const Eigen::MatrixXd L = stored.triangularView<Eigen::Lower>();
  EXPECT_TRUE(matrix_near(Eigen::MatrixXd(L * L.transpose()), S_, 1e-11));
  EXPECT_TRUE(matrix_near(Eigen::MatrixXd(L * W), Eigen::MatrixXd(H_ * before_), 1e-11));
  const Eigen::Map<const Eigen::VectorXd> whitened(gain.nu, rows_);
  EXPECT_TRUE(matrix_near(Eigen::VectorXd(L * whitened), nu_, 1e-11));
  EXPECT_EQ(gain.turn, dx()[2]);
}

TEST_F(UpdateTest, TellsHowAllObservationsGoTogether) {
  const Eigen::MatrixXd S =
      update_.joint_innovation_covariance(P_, layout_, linearizations_).triangularView<Eigen::Lower>();
  EXPECT_TRUE(matrix_near(S, Eigen::MatrixXd(S_.triangularView<Eigen::Lower>()), 1e-11));
}

TEST_F(UpdateTest, LeavesAloneWhatIsOnlyConsidered) {
  constexpr int kHead = 5;
  update_.consider_all_from(kHead);
  ASSERT_TRUE(update_.propose(P_, layout_, linearizations_));
  update_.correct(P_, nullptr);
  Eigen::MatrixXd K = K_;
  K.bottomRows(kSize - kHead).setZero();
  EXPECT_TRUE(matrix_near(dx(), Eigen::VectorXd(K * nu_), 1e-11));
  const Eigen::MatrixXd I_KH = Eigen::MatrixXd::Identity(kSize, kSize) - K * H_;
  const Eigen::MatrixXd joseph = I_KH * before_ * I_KH.transpose() + K * R_ * K.transpose();
  EXPECT_TRUE(matrix_near(now(), joseph, 1e-11));
}

TEST_F(UpdateTest, AllocatesNothing) {
  const test::AllocationCount count;
  ASSERT_TRUE(update_.propose(P_, layout_, linearizations_));
  update_.correct(P_, nullptr);
  EXPECT_EQ(count.allocations(), 0);
}

}  // namespace
}  // namespace waymark::ekf
