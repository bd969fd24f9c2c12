#include "waymark/ekf/compressed_state.hpp"

#include <algorithm>
#include <cassert>
#include <utility>

namespace waymark::ekf {
namespace {

/// A submap can hold what one update sees and something else.
constexpr int kSmallestSubmap = State::kMaxObservations * 3 / 2;
/// A submap has room for this many times what is seen at once, and a part in so many of it stays for the
/// next.
constexpr int kSubmapPerView = 3;

int submap_capacity(int capacity, const Compression& compression) {
  return std::min(capacity, std::max(compression.onset, kSubmapPerView * compression.submap));
}

int slots_for(int capacity, const Compression& compression) {
  const bool never = capacity <= compression.onset;
  return never ? 0 : capacity + submap_capacity(capacity, compression);
}

/// With the indices of the active state.
LinearizedObservation in_active(LinearizedObservation linearization, const Slots& slots) {
  linearization.landmark = slots.local_of(linearization.landmark);
  if (linearization.anchor >= 0) linearization.anchor = slots.local_of(linearization.anchor);
  if (linearization.second_anchor >= 0)
    linearization.second_anchor = slots.local_of(linearization.second_anchor);
  return linearization;
}

/// What left with the last submap is needed until the work for it is done.
int take_slot(Slots& slots, PassiveSubmap& passive) {
  if (!slots.has_freed() || (!passive.done() && slots.has_unused())) return slots.take_unused();
  passive.finish();
  return slots.take_freed();
}

}  // namespace

CompressedState::CompressedState(int dimension, int capacity, Consistency consistency,
                                 const Compression& compression, int threads, int bias_pairs)
    : capacity_(capacity),
      compression_{std::max(compression.submap, kSmallestSubmap),
                   std::max(compression.onset, kSmallestSubmap)},
      active_(dimension, submap_capacity(capacity, compression_), consistency, threads, bias_pairs),
      since_(slots_for(capacity, compression_) > 0 ? active_.offset(active_.capacity()) : 0),
      passive_(dimension, active_.layout().head, slots_for(capacity, compression_),
               slots_for(capacity, compression_) > 0 ? active_.capacity() : 0, threads > 1),
      slots_(capacity, active_.capacity()),
      recency_(active_.capacity()),
      recall_(active_, since_, passive_, slots_.members(), active_.offset(active_.capacity())) {
  local_linearizations_.reserve(kMaxObservations);
}

int CompressedState::limit() const {
  return std::clamp(kSubmapPerView * recency_.max_in_view(),
                    compressing_ ? compression_.submap : std::min(compression_.onset, capacity_),
                    active_.capacity());
}

Eigen::Vector3d CompressedState::landmark(int index) const {
  return is_active(index) ? active_.landmark(slots_.local_of(index))
                          : recall_.position(slots_.slot_of(index));
}

Eigen::Matrix3d CompressedState::landmark_covariance(int index) const {
  return is_active(index) ? active_.landmark_covariance(slots_.local_of(index))
                          : recall_.landmark(slots_.slot_of(index)).covariance;
}

Eigen::Vector3d CompressedState::linearization_landmark(int index) const {
  if (is_active(index)) return active_.linearization_landmark(slots_.local_of(index));
  return linearizes_at_first_estimates(active_.consistency()) ? passive_.first_estimate(slots_.slot_of(index))
                                                              : recall_.position(slots_.slot_of(index));
}

Eigen::Matrix2d CompressedState::innovation_covariance(const LinearizedObservation& linearization) const {
  return is_active(linearization.landmark)
             ? active_.innovation_covariance(in_active(linearization, slots_))
             : recall_.innovation_covariance(slots_.slot_of(linearization.landmark), linearization);
}

Eigen::Matrix<double, 3, 2> CompressedState::pose_correlation(
    const LinearizedObservation& linearization) const {
  return is_active(linearization.landmark)
             ? active_.pose_correlation(in_active(linearization, slots_))
             : recall_.pose_correlation(slots_.slot_of(linearization.landmark), linearization);
}

Eigen::Matrix2d CompressedState::common_covariance(const LinearizedObservation& a,
                                                   const LinearizedObservation& b) const {
  return active_.common_covariance(in_active(a, slots_), in_active(b, slots_));
}

void CompressedState::load(const Eigen::Ref<const Eigen::VectorXd>& mean,
                           const Eigen::Ref<const Eigen::MatrixXd>& P) {
  assert(landmarks() == 0);
  active_.load(mean, P);
  for (int i = 0; i < active_.landmarks(); ++i) {
    const int slot = take_slot(slots_, passive_);
    slots_.append(slot);
    enter(slot);
  }
}

void CompressedState::predict(const Motion& motion, const BiasTerms& errors) {
  assert(!compressing_ || std::ranges::none_of(errors, &BiasTerm::takes_part));
  active_.predict(motion, errors);
  recency_.begin_step();
}

void CompressedState::propagate_bias(int pair, double rho) {
  active_.propagate_bias(pair, rho);
  if (compressing_) since_.propagate_bias(pair, rho);
}

void CompressedState::join() {
  const Eigen::Vector2d phi = active_.propagate_cross_covariance();
  if (compressing_) since_.carry(phi);
}

bool CompressedState::update(std::span<const LinearizedObservation> linearizations) {
  if (!propose(linearizations)) return false;
  accept();
  return true;
}

bool CompressedState::propose(std::span<const LinearizedObservation> linearizations) {
  assert(linearizations.size() <= kMaxObservations);
  if (!std::exchange(proposed_, true)) {
    recency_.begin_update();
    for (const LinearizedObservation& linearization : linearizations)
      recency_.count(slots_.local_of(linearization.landmark));
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
  passive_.work(schedule_.share(passive_.remaining(), limit() - active_.landmarks()));
}

void CompressedState::consider(std::span<const int> landmarks) {
  recency_.begin_update();
  for (const int landmark : landmarks) recency_.count(slots_.local_of(landmark));
  for (const int landmark : landmarks) recency_.mark_seen(slots_.local_of(landmark));
  for (const int landmark : landmarks) activate(landmark);
}

/// All that is observed enters the submap, and the observations get its indices.
void CompressedState::bring_in(std::span<const LinearizedObservation> linearizations) {
  for (const LinearizedObservation& linearization : linearizations)
    recency_.mark_seen(slots_.local_of(linearization.landmark));
  for (const LinearizedObservation& linearization : linearizations) activate(linearization.landmark);
  local_linearizations_.clear();
  for (const LinearizedObservation& linearization : linearizations)
    local_linearizations_.push_back(in_active(linearization, slots_));
}

int CompressedState::add(const Eigen::Vector3d& position, const Eigen::Matrix3d& G_pose,
                         const Eigen::Matrix3d& noise, const BiasTerms& errors) {
  assert(landmarks() < capacity_);
  recency_.count(Recency::kNoMember);
  make_room();
  const int slot = take_slot(slots_, passive_);
  join();
  if (compressing_) {
    passive_.clear(slot);
    since_.append_new(active_.dimension(), G_pose, errors);
  }
  active_.add(position, G_pose, noise, errors);
  enter(slot);
  slots_.append(slot);
  return landmarks() - 1;
}

/// A member of a compressed submap leaves when that is closed: the compressed terms still need it.
void CompressedState::remove(int index) {
  assert(index >= 0 && index < landmarks());
  const int local = slots_.local_of(index);
  if (local < 0) slots_.free(slots_.slot_of(index));
  if (local >= 0) recency_.mark_removed(local);
  if (local >= 0 && !compressing_) leave(local);
  slots_.remove(index);
}

void CompressedState::enter(int slot) {
  slots_.enter(slot);
  recency_.enter();
}

void CompressedState::leave(int local) {
  const bool removed = recency_.is_removed(local);
  active_.remove(local);
  recency_.leave(local);
  const int slot = slots_.leave(local);
  if (removed) slots_.free(slot);
}

void CompressedState::activate(int index) {
  if (is_active(index)) return;
  const int slot = slots_.slot_of(index);
  make_room();
  join();
  const Recall::Landmark now = recall_.landmark(slot);
  since_.append_known(now.base, now.shear);
  active_.insert(now.position, passive_.first_estimate(slot),
                 {active_.dimension(), now.cross.data(), static_cast<std::size_t>(now.cross.outerStride()),
                  now.covariance});
  enter(slot);
}

/// A full submap is closed.
void CompressedState::make_room() {
  if (active_.landmarks() < limit()) return;
  join();
  passive_.finish();
  passive_.close(slots_.members(), active_, compressing_ ? &since_ : nullptr);
  let_the_others_leave();
  since_.restart(active_.size());
  compressing_ = true;
  recency_.begin_submap();
  schedule_ = SwitchSchedule(passive_.remaining(), limit() - active_.landmarks());
  ++closed_submaps_;
}

/// All but those seen last.
void CompressedState::let_the_others_leave() {
  const int in_view = std::min(recency_.in_view(), kMaxObservations);
  Recency::Latest latest =
      recency_.latest(static_cast<std::size_t>(std::max(limit() / kSubmapPerView, in_view)));
  for (int local = active_.landmarks() - 1; local >= 0; --local)
    if (!latest.takes(recency_.seen(local))) leave(local);
}

Eigen::VectorXd CompressedState::mean() const {
  const int dimension = active_.dimension();
  Eigen::VectorXd x(3 + dimension * landmarks());
  const Pose2 robot = active_.pose().T_world_robot;
  x.head<3>() << robot.x_m, robot.y_m, robot.theta_rad;
  for (int i = 0; i < landmarks(); ++i) x.segment(3 + dimension * i, dimension) = landmark(i).head(dimension);
  return x;
}

/// With A the active rows: P_AA from the active state, P_AB from recall(), P_BB = P_BB0 - B^T psi B and its
/// shear.
Eigen::MatrixXd CompressedState::covariance() const {
  passive_.finish();
  const int dimension = active_.dimension();
  const Eigen::Index n = 3 + dimension * landmarks();
  const auto n_active = static_cast<Eigen::Index>(active_.size());
  Eigen::MatrixXd base = Eigen::MatrixXd::Zero(n_active, n);
  Eigen::MatrixXd minus_psi_base = base;
  Eigen::MatrixXd cross = base;
  Eigen::VectorXd shear = Eigen::VectorXd::Zero(n);
  for (int i = 0; i < landmarks(); ++i) {
    if (is_active(i)) continue;
    const Recall::Landmark now = recall_.landmark(slots_.slot_of(i));
    const Eigen::Index row = 3 + dimension * i;
    shear.segment(row, dimension) = now.shear.head(dimension);
    base.middleCols(row, dimension) = now.base;
    minus_psi_base.middleCols(row, dimension) = now.minus_psi_base;
    cross.middleCols(row, dimension) = now.cross;
  }
  const Eigen::VectorXd heading = cross.row(2);  // the shear is in it already
  Eigen::MatrixXd P = base.transpose() * minus_psi_base + shear * heading.transpose() +
                      heading * shear.transpose() - active_.covariance(2, 2) * shear * shear.transpose();
  const auto place = [this, dimension](Eigen::Index i) {
    const auto index = static_cast<int>(i - 3) / dimension;
    const auto coordinate = static_cast<std::size_t>((i - 3) % dimension);
    if (i < 3) return std::pair{true, static_cast<std::size_t>(i)};
    if (is_active(index)) return std::pair{true, active_.offset(slots_.local_of(index)) + coordinate};
    return std::pair{false, passive_.offset(slots_.slot_of(index)) + coordinate};
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
