#include "workbench/study/tune_log.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "workbench/logs/event_list.hpp"
#include "workbench/study/observation_score.hpp"

namespace waymark::study {
namespace {

// What an outlier of a run that broke down costs more than one of a run that did not, nats.
constexpr double kBreakdown = 10.0;

Result<std::vector<Event>> read_events(Source& source) {
  std::vector<Event> events;
  for (;;) {
    auto event = source.next();
    if (!event) return event.error();
    if (!*event) return events;
    events.push_back(std::move(**event));
  }
}

double range_of(const Observation& observation) {
  if (const auto* both = std::get_if<RangeBearing>(&observation.value)) return both->range_m;
  if (const auto* range = std::get_if<Range>(&observation.value)) return range->range_m;
  return 0.0;
}

double longest_range_m(const Recording& recording) {
  double longest_m = 0.0;
  for (const auto& landmark_observation : recording.observations)
    longest_m = std::max(longest_m, range_of(landmark_observation.observation));
  return longest_m;
}

}  // namespace

TuneInput parse_tune_input(std::string_view text) {
  const std::size_t at = text.rfind('@');
  if (at == std::string_view::npos || text.find('=', at) == std::string_view::npos)
    return {std::string(text), {}};
  TuneInput input{std::string(text.substr(0, at)), {}};
  for (std::string_view rest = text.substr(at + 1); !rest.empty();) {
    const std::size_t comma = std::min(rest.find(','), rest.size());
    input.assignments.emplace_back(rest.substr(0, comma));
    rest.remove_prefix(std::min(comma + 1, rest.size()));
  }
  return input;
}

TuneSums& TuneSums::operator+=(const TuneSums& other) {
  log_likelihood += other.log_likelihood;
  observations += other.observations;
  squared_error_m2 += other.squared_error_m2;
  truths += other.truths;
  return *this;
}

Result<TuneLog> TuneLog::open(const std::string& name, UserSettings user) {
  const TuneInput input = parse_tune_input(name);
  user.assignments.insert(user.assignments.end(), input.assignments.begin(), input.assignments.end());
  auto opened = open_input(input.path, user);
  if (!opened) return opened.error();
  TuneLog log;
  log.name_ = name;
  log.config_ = opened->config;
  log.config_.threads = 1;  // threads make runs beside each other
  auto events = read_events(*opened->source);
  if (!events) return events.error();
  log.events_ = *std::move(events);
  log.info_ = opened->source->info();
  log.truth_ = eval::TruthTrack::from_events(log.events_);
  if (auto surveyed = log.survey(); !surveyed) return surveyed.error();
  return log;
}

/// What there is to score, and how it is cut into blocks.
Result<void> TuneLog::survey() {
  const auto recording = record_with({}, true, {});
  if (!recording) return recording.error();
  if (recording->error) return Error{name_ + ": " + recording->error->message};
  const auto& innovations = recording->innovations;
  if (innovations.empty()) return Error{name_ + ": no observations, which tuning needs"};
  odometry_ = recording->odometry;
  observations_ = innovations.size();
  searches_images_ = config_.observe == Observe::kPixel && recording->counts.images > 0;
  log_field_density_ = log_field_density(config_, longest_range_m(*recording));
  for (std::size_t block = 1; block < kTuneBlocks; ++block)
    block_ends_.push_back(innovations[block * innovations.size() / kTuneBlocks].stamp);
  block_counts_.assign(kTuneBlocks, 0);
  for (const auto& innovation : innovations) ++block_counts_[block_of(innovation.stamp)];
  return {};
}

std::size_t TuneLog::block_of(Stamp stamp) const {
  return static_cast<std::size_t>(std::ranges::upper_bound(block_ends_, stamp) - block_ends_.begin());
}

Result<Recording> TuneLog::record_with(const std::vector<std::string>& settings, bool keep_observations,
                                       const KeepGoing& keep_going) const {
  Config config = config_;
  Schema schema = describe(config);
  for (const auto& setting : settings)
    if (auto done = schema.set_assignment(setting, name_); !done) return done.error();
  config.smooth.run = keep_observations;
  EventList source(info_, events_);
  return record(source, config, {}, [&](double) { return !keep_going || keep_going(); });
}

std::optional<std::vector<TuneSums>> TuneLog::sums(const std::vector<std::string>& settings,
                                                   const KeepGoing& keep_going) const {
  const auto recording = record_with(settings, false, keep_going);
  if (keep_going && !keep_going()) return std::nullopt;
  const bool counts =
      recording && !recording->error && (searches_images_ || recording->innovations.size() == observations_);
  if (!counts) return worst();
  std::vector<TuneSums> blocks(kTuneBlocks);
  for (const auto& [stamp, innovation] : recording->innovations) {
    TuneSums& block = blocks[block_of(stamp)];
    block.log_likelihood += log_likelihood(innovation, log_field_density_);
    block.observations += 1.0;
  }
  add_errors(*recording, blocks);
  return blocks;
}

void TuneLog::add_errors(const Recording& recording, std::vector<TuneSums>& blocks) const {
  if (truth_.empty()) return;
  eval::AssociateOptions options;
  if (info_.truth_sensor_m) options.truth_sensor_m = *info_.truth_sensor_m;
  const auto pairs = eval::associate(recording.trajectory, truth_, options);
  const auto fit = eval::fit_path(pairs);
  if (!fit) return;
  for (const auto& error : eval::errors(pairs, fit->T_truth_estimate)) {
    TuneSums& block = blocks[block_of(error.stamp)];
    block.squared_error_m2 += error.position_m.squaredNorm();
    block.truths += 1.0;
  }
}

std::vector<TuneSums> TuneLog::worst() const {
  constexpr double kLost_m = 1e3;
  Innovation outlier;
  outlier.dof = 1;
  outlier.log_density = -HUGE_VAL;
  const double each = log_likelihood(outlier, log_field_density_) - kBreakdown;
  std::vector<TuneSums> blocks;
  for (const std::size_t count : block_counts_) {
    const auto n = static_cast<double>(count);
    blocks.push_back({n * each, n, n * kLost_m * kLost_m, n});
  }
  return blocks;
}

Result<ScoredRun> TuneLog::run(const std::vector<std::string>& settings, const KeepGoing& keep_going) const {
  auto recording = record_with(settings, false, keep_going);
  if (!recording) return recording.error();
  return score_run(name_, config_, info_, *std::move(recording));
}

}  // namespace waymark::study
