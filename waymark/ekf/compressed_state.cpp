#include "waymark/ekf/compressed_state.hpp"

#include <algorithm>
#include <cassert>
#include <functional>
#include <utility>

namespace waymark::ekf {
namespace {

/// A submap can hold what one update sees and something else.
constexpr int kSmallestSubmap = State::kMaxObservations * 3 / 2;
/// A submap has room for this many times what is seen at once, and a part in so many of it stays for the
/// next.
constexpr int kSubmapPerView = 3;
/// Over how many updates the work of a switch of submap is spread, if there is time.
constexpr double kSpread = 256.0;

int submap_capacity(int capacity, const Compression& compression) {
  return std::min(capacity, std::max(compression.onset, kSubmapPerView * compression.submap));
}

int slots_for(int capacity, const Compression& compression) {
  const bool never = capacity <= compression.onset;
  return never ? 0 : capacity + submap_capacity(capacity, compression);
}

/// P(row, :) J^T for the robot and the errors that something depends on.
Eigen::Vector2d correlation(const Belief& state, std::size_t row, const Touched& touched) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (Eigen::Index k = 0; k < touched.head; ++k)
    sum += state.covariance(row, touched.rows[static_cast<std::size_t>(k)]) * touched.J.col(k).head<2>();
  return sum;
}

}  // namespace

CompressedState::CompressedState(int dimension, int capacity, Consistency consistency,
                                 const Compression& compression, int threads, int error_pairs)
    : capacity_(capacity),
      compression_{std::max(compression.submap, kSmallestSubmap),
                   std::max(compression.onset, kSmallestSubmap)},
      active_(dimension, submap_capacity(capacity, compression_), consistency, threads, error_pairs),
      since_(slots_for(capacity, compression_) > 0 ? active_.offset(active_.capacity()) : 0),
      passive_(dimension, active_.layout().head, slots_for(capacity, compression_),
               slots_for(capacity, compression_) > 0 ? active_.capacity() : 0, threads > 1),
      local_of_slot_(static_cast<std::size_t>(capacity + active_.capacity()), -1),
      base_(active_.offset(active_.capacity()), dimension),
      minus_psi_base_(base_.rows(), dimension),
      cross_(base_.rows(), dimension) {
  slots_.reserve(static_cast<std::size_t>(capacity));
  free_slots_.reserve(local_of_slot_.size());
  for (auto* by_member : {&seen_, &ranked_}) by_member->reserve(static_cast<std::size_t>(active_.capacity()));
  members_.reserve(static_cast<std::size_t>(active_.capacity()));
  local_linearizations_.reserve(kMaxObservations);
}

int CompressedState::limit() const {
  return std::clamp(kSubmapPerView * max_seen_,
                    compressing_ ? compression_.submap : std::min(compression_.onset, capacity_),
                    active_.capacity());
}

void CompressedState::load(const Eigen::Ref<const Eigen::VectorXd>& mean,
                           const Eigen::Ref<const Eigen::MatrixXd>& P) {
  assert(slots_.empty());
  active_.load(mean, P);
  for (int i = 0; i < active_.landmarks(); ++i) {
    slots_.push_back(take_slot());
    enter(slots_.back());
  }
}

void CompressedState::predict(const Motion& motion, const ErrorTerms& errors) {
  assert(!compressing_ || std::ranges::none_of(errors, &ErrorTerm::takes_part));
  active_.predict(motion, errors);
  step_began_ = now_;
  seen_this_step_ = 0;
}

void CompressedState::propagate_bias(int pair, double rho) {
  active_.propagate_bias(pair, rho);
  if (compressing_) since_.propagate_bias(pair, rho);
}

void CompressedState::join() {
  const Eigen::Vector2d displacement = active_.propagate_cross_covariance();
  if (compressing_) since_.carry(displacement);
}

bool CompressedState::update(std::span<const LinearizedObservation> linearizations) {
  if (!propose(linearizations)) return false;
  accept();
  return true;
}

bool CompressedState::propose(std::span<const LinearizedObservation> linearizations) {
  assert(linearizations.size() <= kMaxObservations);
  if (!std::exchange(proposed_, true)) {
    ++now_;
    for (const LinearizedObservation& linearization : linearizations) count(linearization.landmark);
  }
  bring_in(linearizations);
  join();
  proposed_ = active_.propose(local_linearizations_);
  return proposed_;
}

void CompressedState::accept() {
  proposed_ = false;
  if (!local_linearizations_.empty()) {
    if (compressing_) since_.project(local_linearizations_, active_.layout());
    active_.accept();
    if (compressing_) since_.absorb(active_.gain());
  }
  work();
}

/// What is proposed again in a step counts once.
void CompressedState::count(int landmark) {
  const bool again = is_active(landmark) && seen_[static_cast<std::size_t>(local_of(landmark))] > step_began_;
  seen_this_step_ += again ? 0 : 1;
  max_seen_ = std::max(max_seen_, seen_this_step_);
}

void CompressedState::consider(std::span<const int> landmarks) {
  ++now_;
  for (const int landmark : landmarks) count(landmark);
  for (const int landmark : landmarks) mark_seen(landmark);
  for (const int landmark : landmarks)
    if (!is_active(landmark)) activate(slot_of(landmark));
}

void CompressedState::mark_seen(int landmark) {
  if (is_active(landmark)) seen_[static_cast<std::size_t>(local_of(landmark))] = now_;
}

/// All that is sighted enters the submap, and the observations get its indices.
void CompressedState::bring_in(std::span<const LinearizedObservation> linearizations) {
  for (const LinearizedObservation& linearization : linearizations) mark_seen(linearization.landmark);
  for (const LinearizedObservation& linearization : linearizations)
    if (!is_active(linearization.landmark)) activate(slot_of(linearization.landmark));
  local_linearizations_.assign(linearizations.begin(), linearizations.end());
  for (LinearizedObservation& linearization : local_linearizations_) linearization = in_active(linearization);
}

/// An even share; and more if more work than room is left, halfway through the submap and later, so that none
/// is left when it is full.
void CompressedState::work() {
  const double room_left =
      std::max(limit() - active_.landmarks(), 0) / static_cast<double>(std::max(room_, 1));
  const double due = passive_.remaining() - closing_work_ * std::min(1.0, 2.0 * room_left);
  passive_.work(std::max(closing_work_ / kSpread, due));
}

int CompressedState::add(const Eigen::Vector3d& position, const Eigen::Matrix3d& G_pose,
                         const Eigen::Matrix3d& noise, const ErrorTerms& errors) {
  assert(landmarks() < capacity_);
  ++seen_this_step_;
  max_seen_ = std::max(max_seen_, seen_this_step_);
  make_room();
  const int slot = take_slot();
  join();
  if (compressing_) {
    passive_.clear(slot);
    since_.append_new(dimension(), G_pose, errors);
  }
  active_.add(position, G_pose, noise, errors);
  enter(slot);
  slots_.push_back(slot);
  return landmarks() - 1;
}

void CompressedState::remove(int index) {
  assert(index >= 0 && index < landmarks());
  const int slot = slot_of(index);
  const int local = local_of(index);
  if (local < 0) free_slots_.push_back(slot);
  if (local >= 0) seen_[static_cast<std::size_t>(local)] = kRemoved;
  if (local >= 0 && !compressing_)
    leave(local);  // else when the submap is closed: the compressed terms still need it
  slots_[static_cast<std::size_t>(index)] = slots_.back();
  slots_.pop_back();
}

int CompressedState::take_slot() {
  // What left with the last submap is needed until the work for it is done.
  const bool fresh = used_slots_ < static_cast<int>(local_of_slot_.size());
  if (free_slots_.empty() || (!passive_.done() && fresh)) return used_slots_++;
  passive_.finish();
  const int slot = free_slots_.back();
  free_slots_.pop_back();
  return slot;
}

void CompressedState::enter(int slot) {
  local_of_slot_[static_cast<std::size_t>(slot)] = static_cast<int>(members_.size());
  members_.push_back(slot);
  seen_.push_back(now_);
}

void CompressedState::leave(int local) {
  const auto at = static_cast<std::size_t>(local);
  const int slot = members_[at];
  if (seen_[at] == kRemoved) free_slots_.push_back(slot);
  active_.remove(local);
  members_[at] = members_.back();
  seen_[at] = seen_.back();
  local_of_slot_[static_cast<std::size_t>(members_[at])] = local;
  local_of_slot_[static_cast<std::size_t>(slot)] = -1;
  members_.pop_back();
  seen_.pop_back();
}

void CompressedState::activate(int slot) {
  make_room();
  join();
  const Recalled recalled = recall(slot);
  const auto n = static_cast<Eigen::Index>(active_.size());
  since_.append_known(base_.topRows(n), recalled.shear);
  active_.insert(
      recalled.position, passive_.first_estimate(slot),
      {dimension(), cross_.data(), static_cast<std::size_t>(cross_.outerStride()), recalled.covariance});
  enter(slot);
}

void CompressedState::make_room() {
  if (active_.landmarks() >= limit()) close_submap();
}

void CompressedState::close_submap() {
  join();
  passive_.finish();
  passive_.close(members_, active_, compressing_ ? &since_ : nullptr);
  let_the_others_leave();
  since_.restart(active_.size());
  closing_work_ = passive_.remaining();
  compressing_ = true;
  max_seen_ = seen_this_step_;
  room_ = limit() - active_.landmarks();
  ++closed_submaps_;
}

/// All but those seen last.
void CompressedState::let_the_others_leave() {
  const int in_view = std::min(seen_this_step_, kMaxObservations);
  const auto stay = static_cast<std::size_t>(std::max(limit() / kSubmapPerView, in_view));
  Clock oldest = 0;
  std::ptrdiff_t as_old = active_.landmarks();
  if (stay < seen_.size()) {
    ranked_ = seen_;
    std::nth_element(ranked_.begin(), ranked_.begin() + static_cast<std::ptrdiff_t>(stay) - 1, ranked_.end(),
                     std::greater<>());
    oldest = ranked_[stay - 1];
    as_old = static_cast<std::ptrdiff_t>(stay) -
             std::ranges::count_if(seen_, [&](Clock seen) { return seen > oldest; });
  }
  for (int local = active_.landmarks() - 1; local >= 0; --local) {
    const Clock seen = seen_[static_cast<std::size_t>(local)];
    const bool stays = seen != kRemoved && (seen > oldest || (seen == oldest && as_old-- > 0));
    if (!stays) leave(local);
  }
}

/// What the submap's corrections did to a passive landmark, whose columns are in base_.
Eigen::Vector3d CompressedState::displacement(int slot) const {
  const auto n = static_cast<Eigen::Index>(active_.size());
  passive_.columns(slot, members_, base_.topRows(n));
  Eigen::Vector3d moved = Eigen::Vector3d::Zero();
  moved.head(dimension()).noalias() =
      base_.topRows(n).transpose() * Eigen::Map<const Eigen::VectorXd>(since_.tau(), n);
  moved.head<2>() = Retraction(active_.consistency(), since_.turn()).displacement(moved.head<2>());
  return moved;
}

CompressedState::Recalled CompressedState::recall(int slot) const {
  const Eigen::Vector3d moved = displacement(slot);
  Recalled now{passive_.position(slot) + moved, Eigen::Vector3d::Zero(), passive_.covariance(slot)};
  now.shear.head<2>() = Retraction(active_.consistency(), since_.turn()).shear(moved.head<2>());
  const auto n = static_cast<Eigen::Index>(active_.size());
  for (int a = 0; a < dimension(); ++a) {
    since_.multiply_phi(base_.col(a).head(n), cross_.col(a).head(n));
    since_.multiply_minus_psi(base_.col(a).head(n), minus_psi_base_.col(a).head(n));
    cross_.col(a).head<2>() += active_.deferred() * cross_(2, a);
  }
  Eigen::Vector3d c = Eigen::Vector3d::Zero();
  c.head(dimension()) = cross_.row(2);
  now.covariance.topLeftCorner(dimension(), dimension()).noalias() +=
      base_.topRows(n).transpose().lazyProduct(minus_psi_base_.topRows(n));
  now.covariance += now.shear * c.transpose() + c * now.shear.transpose() +
                    active_.covariance(2, 2) * now.shear * now.shear.transpose();
  for (Eigen::Index i = 0; i < n; ++i)
    cross_.row(i) +=
        active_.covariance(static_cast<std::size_t>(i), 2) * now.shear.head(dimension()).transpose();
  return now;
}

Eigen::Vector3d CompressedState::landmark(int index) const {
  if (is_active(index)) return active_.landmark(local_of(index));
  return passive_.position(slot_of(index)) + displacement(slot_of(index));
}

Eigen::Matrix3d CompressedState::landmark_covariance(int index) const {
  return is_active(index) ? active_.landmark_covariance(local_of(index)) : recall(slot_of(index)).covariance;
}

Eigen::Vector3d CompressedState::linearization_landmark(int index) const {
  if (is_active(index)) return active_.linearization_landmark(local_of(index));
  return linearizes_at_first_estimates(active_.consistency()) ? passive_.first_estimate(slot_of(index))
                                                              : landmark(index);
}

LinearizedObservation CompressedState::in_active(const LinearizedObservation& linearization) const {
  LinearizedObservation local = linearization;
  local.landmark = local_of(linearization.landmark);
  if (linearization.anchor >= 0) local.anchor = local_of(linearization.anchor);
  if (linearization.second_anchor >= 0) local.second_anchor = local_of(linearization.second_anchor);
  return local;
}

LinearizedObservation CompressedState::relinearized_to_prior(
    const LinearizedObservation& linearization) const {
  LinearizedObservation back = active_.relinearized_to_prior(in_active(linearization));
  back.landmark = linearization.landmark;
  back.anchor = linearization.anchor;
  back.second_anchor = linearization.second_anchor;
  return back;
}

Eigen::Matrix2d CompressedState::innovation_covariance(const LinearizedObservation& linearization) const {
  if (is_active(linearization.landmark)) return active_.innovation_covariance(in_active(linearization));
  const Recalled now = recall(slot_of(linearization.landmark));
  const Touched head(linearization.H_pose, linearization.errors);
  const auto H_landmark = linearization.H_landmark.leftCols(dimension());
  Eigen::Matrix2d S =
      linearization.R + linearization.H_landmark * now.covariance * linearization.H_landmark.transpose();
  for (Eigen::Index k = 0; k < head.head; ++k) {
    const std::size_t row = head.rows[static_cast<std::size_t>(k)];
    const Eigen::Vector2d J = head.J.col(k).head<2>();
    const Eigen::Matrix2d cross = J * (cross_.row(static_cast<Eigen::Index>(row)) * H_landmark.transpose());
    S += J * correlation(active_, row, head).transpose() + cross + cross.transpose();
  }
  return S;
}

Eigen::Matrix<double, 3, 2> CompressedState::pose_correlation(
    const LinearizedObservation& linearization) const {
  if (is_active(linearization.landmark)) return active_.pose_correlation(in_active(linearization));
  (void)recall(slot_of(linearization.landmark));
  const Touched head(linearization.H_pose, linearization.errors);
  Eigen::Matrix<double, 3, 2> C =
      cross_.topRows<3>() * linearization.H_landmark.leftCols(dimension()).transpose();
  for (int i = 0; i < 3; ++i) C.row(i) += correlation(active_, static_cast<std::size_t>(i), head).transpose();
  return C;
}

Eigen::VectorXd CompressedState::mean() const {
  Eigen::VectorXd x(3 + dimension() * landmarks());
  const Pose2 robot = pose().T_world_robot;
  x.head<3>() << robot.x_m, robot.y_m, robot.theta_rad;
  for (int i = 0; i < landmarks(); ++i)
    x.segment(3 + dimension() * i, dimension()) = landmark(i).head(dimension());
  return x;
}

/// With A the active rows: P_AA from the active state, P_AB from recall(), P_BB = P_BB0 - B^T psi B and its
/// shear.
Eigen::MatrixXd CompressedState::covariance() const {
  passive_.finish();
  const Eigen::Index n = row(landmarks());
  const auto n_active = static_cast<Eigen::Index>(active_.size());
  Eigen::MatrixXd base = Eigen::MatrixXd::Zero(n_active, n);
  Eigen::MatrixXd minus_psi_base = base;
  Eigen::MatrixXd cross = base;
  Eigen::VectorXd shear = Eigen::VectorXd::Zero(n);
  for (int i = 0; i < landmarks(); ++i) {
    if (is_active(i)) continue;
    shear.segment(row(i), dimension()) = recall(slot_of(i)).shear.head(dimension());
    base.middleCols(row(i), dimension()) = base_.topRows(n_active);
    minus_psi_base.middleCols(row(i), dimension()) = minus_psi_base_.topRows(n_active);
    cross.middleCols(row(i), dimension()) = cross_.topRows(n_active);
  }
  const Eigen::VectorXd heading = cross.row(2);  // the shear is in it already
  Eigen::MatrixXd P = base.transpose() * minus_psi_base + shear * heading.transpose() +
                      heading * shear.transpose() - active_.covariance(2, 2) * shear * shear.transpose();
  const auto place = [this](Eigen::Index i) {
    const auto index = static_cast<int>(i - 3) / dimension();
    const auto coordinate = static_cast<std::size_t>((i - 3) % dimension());
    if (i < 3) return std::pair{true, static_cast<std::size_t>(i)};
    if (is_active(index)) return std::pair{true, active_.offset(local_of(index)) + coordinate};
    return std::pair{false, passive_.offset(slot_of(index)) + coordinate};
  };
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto [i_active, a] = place(i);
    for (Eigen::Index j = i; j < n; ++j) {
      const auto [j_active, b] = place(j);
      if (i_active && j_active) P(i, j) = active_.covariance(a, b);
      if (i_active && !j_active) P(i, j) = cross(static_cast<Eigen::Index>(a), j);
      if (!i_active && j_active) P(i, j) = cross(static_cast<Eigen::Index>(b), i);
      if (!i_active && !j_active) P(i, j) += passive_.covariance(a, b);
      P(j, i) = P(i, j);
    }
  }
  return P;
}

}  // namespace waymark::ekf
