#include "waymark/ekf/passive_submap.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <numeric>

#include "waymark/kernels/add_scaled_rows.hpp"
#include "waymark/kernels/layout.hpp"
#include "waymark/kernels/symmetric_update.hpp"

namespace waymark::ekf {
namespace {

/// Columns brought up to date at once: one tile of the widest vectors, and whole landmarks of two or three
/// coordinates.
constexpr std::size_t kColumns = 24;
/// Rows of P_bb brought up to date at once.
constexpr std::size_t kRows = 8;

std::size_t ceil_multiple(std::size_t value, std::size_t of) { return (value + of - 1) / of * of; }

}  // namespace

// The robot's rows are filled up to whole landmarks, so that none lies in two blocks of columns.
PassiveSubmap::PassiveSubmap(int dimension, std::size_t head, int slots, int members, bool own_thread)
    : dimension_(dimension),
      head_(head),
      robot_rows_(ceil_multiple(head, static_cast<std::size_t>(dimension))),
      ld_(kernels::padded_stride(offset(slots))),
      P_(ld_ * ld_),
      x_(ld_),
      first_(ld_),
      submap_ld_(kernels::padded_stride(head + static_cast<std::size_t>(dimension * members))),
      inside_(ld_),
      minus_phi_transposed_(submap_ld_ * submap_ld_),
      minus_psi_(submap_ld_ * submap_ld_),
      tau_(submap_ld_),
      heading_(submap_ld_),
      updated_(ld_ / kColumns + 1),
      B_(submap_ld_ * ld_),
      psi_b_(submap_ld_ * ld_),
      phi_b_(submap_ld_ * kColumns),
      d_(ld_),
      e_(ld_),
      background_(own_thread && slots > 0) {
  rows_.reserve(submap_ld_);
  asked_.reserve(submap_ld_);
}

Eigen::Vector3d PassiveSubmap::point(const Buffer& buffer, int slot) const {
  const double* p = &buffer[offset(slot)];
  return {p[0], p[1], dimension_ == 3 ? p[2] : 0.0};
}

void PassiveSubmap::clear(int slot) {
  background_.wait();
  slots_ = std::max(slots_, slot + 1);
  for (std::size_t at = offset(slot); at < offset(slot + 1); ++at) {
    for (std::size_t j = 0; j < size(); ++j) P(at, j) = 0.0;
    for (std::size_t k = 0; k < rows_.size(); ++k) B_[k * ld_ + at] = psi_b_[k * ld_ + at] = 0.0;
    x_[at] = d_[at] = e_[at] = 0.0;
  }
}

void PassiveSubmap::list_rows(std::span<const int> members, std::vector<std::size_t>& rows) const {
  rows.resize(head_);
  std::iota(rows.begin(), rows.end(), std::size_t{0});
  for (const int slot : members)
    for (std::size_t at = offset(slot); at < offset(slot + 1); ++at) rows.push_back(at);
}

void PassiveSubmap::close(std::span<const int> members, const Belief& submap, const CompressedTerms* since) {
  assert(done());
  list_rows(members, rows_);
  store(members, submap);
  if (since != nullptr) take_over(*since, submap);
}

void PassiveSubmap::store(std::span<const int> members, const Belief& submap) {
  for (std::size_t i = 0; i < rows_.size(); ++i)
    for (std::size_t j = i; j < rows_.size(); ++j) P(rows_[i], rows_[j]) = submap.covariance(i, j);
  for (std::size_t k = 0; k < members.size(); ++k) {
    const std::size_t at = offset(members[k]);
    const auto index = static_cast<int>(k);
    std::copy_n(submap.landmark(index).data(), dimension_, &x_[at]);
    std::copy_n(submap.first_estimate(index).data(), dimension_, &first_[at]);
  }
}

void PassiveSubmap::take_over(const CompressedTerms& since, const Belief& submap) {
  const std::size_t na = since.size();
  for (std::size_t i = 0; i < na; ++i) {
    for (std::size_t j = 0; j < na; ++j)
      minus_phi_transposed_[j * submap_ld_ + i] = -since.phi()[i * since.stride() + j];
    for (std::size_t j = i; j < na; ++j)
      minus_psi_[i * submap_ld_ + j] = minus_psi_[j * submap_ld_ + i] =
          since.minus_psi()[i * since.stride() + j];
    heading_[i] = submap.covariance(i, 2);
  }
  std::copy_n(since.tau(), na, tau_.data());
  retraction_ = Retraction(submap.consistency(), since.turn());
  n_ = size();
  std::ranges::fill(inside_, 0);
  for (const std::size_t row : rows_) inside_[row] = 1;
  std::ranges::fill(updated_, 0);
  next_block_ = next_row_ = 0;
  credit_ = 0.0;
  working_ = true;
}

/// Phase one: blocks of columns; phase two: rows.
double PassiveSubmap::next_cost() const {
  const auto na = static_cast<double>(rows_.size());
  if (next_block_ * kColumns < n_)
    return updated_[next_block_] ? 0.0 : 4.0 * na * na * static_cast<double>(kColumns);
  return 2.0 * na * static_cast<double>(kRows * (n_ - next_row_));
}

bool PassiveSubmap::done() {
  background_.wait();
  return !working_;
}

double PassiveSubmap::remaining() {
  if (done()) return 0.0;
  const auto na = static_cast<double>(rows_.size());
  const auto columns = static_cast<double>(n_ - std::min(n_, next_block_ * kColumns));
  const auto rows = static_cast<double>(n_ - next_row_);
  return 4.0 * na * na * columns + na * rows * rows;
}

void PassiveSubmap::do_next() {
  if (next_block_ * kColumns < n_) return update_columns(next_block_++);
  const std::size_t end = std::min(next_row_ + kRows, n_);
  kernels::symmetric_product_update(P_.data(), ld_, n_, B_.data(), psi_b_.data(), ld_, rows_.size(),
                                    retraction_.turns() ? d_.data() : nullptr,
                                    retraction_.turns() ? e_.data() : nullptr, {next_row_, end});
  next_row_ = end;
  working_ = next_row_ < n_;
}

void PassiveSubmap::work(double flop) {
  if (done()) return;
  credit_ += flop;
  background_.start<&PassiveSubmap::spend_credit>(this);
}

void PassiveSubmap::spend_credit() {
  while (working_ && next_cost() <= credit_) {
    credit_ -= next_cost();
    do_next();
  }
}

void PassiveSubmap::finish() {
  background_.wait();
  while (working_) do_next();
}

void PassiveSubmap::update_columns_of(int slot) {
  if (working_ && offset(slot) < n_) update_columns(offset(slot) / kColumns);
}

/// Phase one for one block of columns.
void PassiveSubmap::update_columns(std::size_t block) {
  if (updated_[block]) return;
  updated_[block] = 1;
  const std::size_t begin = block * kColumns;
  const std::size_t end = std::min(begin + kColumns, n_);
  const std::size_t na = rows_.size();
  for (std::size_t k = 0; k < na; ++k) {
    for (std::size_t j = begin; j < end; ++j) B_[k * ld_ + j] = inside_[j] ? 0.0 : P(rows_[k], j);
    std::fill(&psi_b_[k * ld_ + begin], &psi_b_[k * ld_] + end, 0.0);
    std::fill_n(&phi_b_[k * kColumns], kColumns, 0.0);
  }
  const double* B = &B_[begin];
  kernels::subtract_product(&psi_b_[begin], ld_, end - begin, minus_psi_.data(), submap_ld_, B, ld_, na,
                            {0, na});
  kernels::subtract_product(phi_b_.data(), kColumns, end - begin, minus_phi_transposed_.data(), submap_ld_, B,
                            ld_, na, {0, na});
  move_points(begin, end);
  write_back(begin, end);
}

/// x_b and the shear that goes with it, to first order: as if all corrections had come at once at the end.
void PassiveSubmap::move_points(std::size_t begin, std::size_t end) {
  alignas(kernels::kAlignment) std::array<double, kColumns> moved{};
  kernels::add_scaled_rows(moved.data(), &B_[begin], ld_, rows_.size(), tau_.data(), end - begin);
  const auto stride = static_cast<std::size_t>(dimension_);
  for (std::size_t j = begin; retraction_.turns() && j < end; j += stride) {
    Eigen::Map<Eigen::Vector2d> ground(&moved[j - begin]);
    ground = retraction_.displacement(ground);
    Eigen::Map<Eigen::Vector2d> d(&d_[j]);
    d = retraction_.shear(ground);
  }
  const double half_c_theta = 0.5 * heading_[2];
  for (std::size_t j = begin; j < end; ++j) {
    x_[j] += moved[j - begin];
    e_[j] = inside_[j] ? 0.0 : phi_b_[2 * kColumns + j - begin] + half_c_theta * d_[j];
  }
}

void PassiveSubmap::write_back(std::size_t begin, std::size_t end) {
  for (std::size_t k = 0; k < rows_.size(); ++k)
    for (std::size_t j = begin; j < end; ++j)
      if (!inside_[j])
        P(rows_[k], j) = phi_b_[k * kColumns + j - begin] + (retraction_.turns() ? heading_[k] * d_[j] : 0.0);
}

/// P(i, j) as it will be when the work is done; both columns are up to date.
double PassiveSubmap::present(std::size_t i, std::size_t j) {
  const auto [row, column] = std::minmax(i, j);
  double p = P(row, column);
  if (!working_ || row < next_row_ || column >= n_ || inside_[row] || inside_[column]) return p;
  for (std::size_t k = 0; k < rows_.size(); ++k) p -= B_[k * ld_ + row] * psi_b_[k * ld_ + column];
  return retraction_.turns() ? p + d_[row] * e_[column] + e_[row] * d_[column] : p;
}

Eigen::Vector3d PassiveSubmap::position(int slot) {
  background_.wait();
  update_columns_of(slot);
  return point(x_, slot);
}

Eigen::Matrix3d PassiveSubmap::covariance(int slot) {
  background_.wait();
  update_columns_of(slot);
  Eigen::Matrix3d P_slot = Eigen::Matrix3d::Zero();
  for (int a = 0; a < dimension_; ++a)
    for (int b = 0; b < dimension_; ++b)
      P_slot(a, b) =
          present(offset(slot) + static_cast<std::size_t>(a), offset(slot) + static_cast<std::size_t>(b));
  return P_slot;
}

void PassiveSubmap::columns(int slot, std::span<const int> members, Eigen::Ref<Eigen::MatrixXd> out) {
  background_.wait();
  update_columns_of(slot);
  for (const int member : members) update_columns_of(member);
  list_rows(members, asked_);
  for (int a = 0; a < dimension_; ++a)
    for (std::size_t k = 0; k < asked_.size(); ++k)
      out(static_cast<Eigen::Index>(k), a) = present(asked_[k], offset(slot) + static_cast<std::size_t>(a));
}

}  // namespace waymark::ekf
