#include "workbench/study/sweep.hpp"

#include <algorithm>
#include <utility>

namespace waymark::study {

Result<std::unique_ptr<Sweep>> Sweep::open(const SweepPlan& plan, const std::filesystem::path& folder) {
  if (auto checked = check(plan); !checked) return checked.error();
  auto journal = SweepJournal::open(plan, folder);
  if (!journal) return journal.error();
  return std::unique_ptr<Sweep>(new Sweep(plan, *std::move(journal)));
}

Sweep::Sweep(const SweepPlan& plan, SweepJournal journal)
    : plan_(plan), points_(points(plan)), journal_(std::move(journal)), rows_(points_.size()) {
  for (std::size_t i = 0; i < points_.size(); ++i) places_.emplace(points_[i], i);
  for (const auto& row : journal_.rows()) {
    const auto place = places_.find(row.point);
    if (place != places_.end()) rows_[place->second] = row;
  }
  resumed_ = done_ =
      static_cast<std::size_t>(std::ranges::count_if(rows_, [](const auto& row) { return row.has_value(); }));
}

std::optional<std::size_t> Sweep::take() {
  const std::lock_guard lock(mutex_);
  while (next_ < rows_.size() && rows_[next_]) ++next_;
  if (stopped_ || next_ == rows_.size()) return std::nullopt;
  return next_++;
}

void Sweep::finish(SweepRow row) {
  const std::lock_guard lock(mutex_);
  const auto place = places_.find(row.point);
  if (place == places_.end()) return;
  if (auto added = journal_.add(row); !added) stop_for(added.error());
  auto& kept = rows_[place->second];
  done_ += kept ? 0 : 1;
  kept = std::move(row);
}

void Sweep::fail(Error error) {
  const std::lock_guard lock(mutex_);
  stop_for(std::move(error));
}

void Sweep::stop_for(Error error) {
  if (!error_) error_ = std::move(error);
  stopped_ = true;
}

void Sweep::stop() {
  const std::lock_guard lock(mutex_);
  stopped_ = true;
}

std::size_t Sweep::done() const {
  const std::lock_guard lock(mutex_);
  return done_;
}

bool Sweep::stopped() const {
  const std::lock_guard lock(mutex_);
  return stopped_;
}

std::optional<Error> Sweep::error() const {
  const std::lock_guard lock(mutex_);
  return error_;
}

std::vector<SweepRow> Sweep::rows() const {
  const std::lock_guard lock(mutex_);
  std::vector<SweepRow> rows;
  for (const auto& row : rows_)
    if (row) rows.push_back(*row);
  return rows;
}

std::string csv(const SweepPlan& plan, const std::vector<SweepRow>& rows) {
  std::string text = csv_header(plan) + "\n";
  for (const auto& row : rows) text += to_csv(row) + "\n";
  return text;
}

}  // namespace waymark::study
