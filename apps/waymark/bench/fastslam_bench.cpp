#include "fastslam_bench.hpp"

#include <array>
#include <chrono>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <utility>

#include "waymark/core/function_blocks.hpp"
#include "waymark/fastslam/fast_slam.hpp"

#include "plain_fastslam.hpp"
#include "synthetic_run.hpp"
#include "wall_time.hpp"
#include "workbench/eval/median.hpp"

namespace waymark::app {
namespace {

struct FastSlamPlan {
  std::size_t rounds;
  int steps;                ///< per round
  int particles;            ///< of the whole steps
  std::array<int, 4> maps;  ///< sizes among which resampling is compared
  int many;                 ///< particles of the largest run; 0: none
};

FastSlamPlan fastslam_plan(BenchScope scope) {
  if (scope == BenchScope::kQuick) return {3, 20, 200, {10, 100, 300, 1000}, 0};
  return {7, 40, 1000, {10, 100, 1000, 10000}, 1'000'000};
}

enum class Kind { kRangeBearing, kRange, kBearing };

const char* name_of(Kind kind) {
  return kind == Kind::kRangeBearing ? "range-bearing" : kind == Kind::kRange ? "range" : "bearing";
}

const char* name_of(ProposalKind proposal) { return proposal == ProposalKind::kMotion ? "1.0" : "2.0"; }

Observations of_kind(Kind kind, Observations observations) {
  for (Observation& each : observations) {
    const auto z = std::get<RangeBearing>(each.value);
    const Eigen::Matrix2d R = *each.covariance;
    if (kind == Kind::kRange) each.value = Range{z.range_m};
    if (kind != Kind::kBearing) continue;
    each.value = Bearing{z.bearing_rad};
    each.covariance = Eigen::Matrix2d{{R(1, 1), 0.0}, {0.0, 0.0}};
  }
  return observations;
}

/// A filter that has seen every landmark once, by range and bearing.
std::unique_ptr<FastSlam> start_filter(const SyntheticRun& run, FastSlamOptions options, int threads = 1) {
  options.capacity = static_cast<int>(run.first_look.size());
  auto filter = std::make_unique<FastSlam>(options, LandmarkSensor{}, threads);
  filter->correct(run.first_look);
  return filter;
}

Duration spent(const FunctionBlocks& blocks, std::string_view name) {
  for (const auto& row : blocks.rows())
    if (row.name == name) return row.total;
  return {};
}

/// Median over rounds of what job(round) says.
double median_of_rounds(std::size_t rounds, const std::function<double(std::size_t)>& job) {
  std::vector<double> values;
  for (std::size_t round = 0; round < rounds; ++round) values.push_back(job(round));
  return *eval::median(values);
}

/// Some landmarks as particles know them, block by block, as a step updates them.
class LandmarkUpdates {
 public:
  LandmarkUpdates(int particles, Kind kind) : blocks_(particles), particles_(particles, {}), store_(blocks_) {
    const kernels::LandmarkMeasurement first{
        kernels::ObservationKind::kRangeBearing, 5.0F, 0.8F, 0.6F, 0.01F, 0.0F, 0.001F};
    for (int k = 0; k < kObservations; ++k) {
      observations_[static_cast<std::size_t>(k)] = {
          first, {}, store_.view(store_.add(kernels::LandmarkForm::kPoint, {0.0, 0.0}), {0.0, 0.0})};
      place(observations_[static_cast<std::size_t>(k)]);
      observations_[static_cast<std::size_t>(k)].seen.kind = kind_of(kind);
    }
  }

  /// Of one landmark of one particle.
  double time_ns(ProposalKind proposal, int repetitions) {
    const Duration start = thread_cpu_time();
    for (int i = 0; i < repetitions; ++i)
      blocks_.run([&](std::size_t begin, std::size_t end) { update(proposal, {begin, end - begin}); });
    return 1e9 * to_seconds(thread_cpu_time() - start) /
           (static_cast<double>(repetitions) * particles_.count() * kObservations);
  }

 private:
  static kernels::ObservationKind kind_of(Kind kind) {
    if (kind == Kind::kRange) return kernels::ObservationKind::kRange;
    return kind == Kind::kBearing ? kernels::ObservationKind::kBearing
                                  : kernels::ObservationKind::kRangeBearing;
  }

  void place(const kernels::LandmarkObservation& observation) {
    blocks_.run([&](std::size_t begin, std::size_t end) {
      fastslam::BlockScratch scratch;
      const kernels::ParticleRange range{begin, end - begin};
      kernels::place_landmark(observation, {},
                              fastslam::load_sensors(particles_, {}, {0.0, 0.0}, range, scratch), range);
    });
  }

  void update(ProposalKind proposal, kernels::ParticleRange range) {
    fastslam::BlockScratch scratch;
    const auto sensors = fastslam::load_sensors(particles_, {}, {0.0, 0.0}, range, scratch);
    double* const log_weight = particles_.log_weights().data() + range.begin;
    if (proposal == ProposalKind::kMotion) {
      for (const auto& each : observations_) kernels::update_landmark(each, sensors, 1.0, log_weight, range);
      return;
    }
    const kernels::Increment increment{0.1F, 0.0F, 0.01F, 1e-4F, 0.0F, 0.0F, 1e-4F, 0.0F, 1e-4F};
    kernels::fill_increments(increment, scratch.increments(), range.count);
    for (const auto& each : observations_)
      kernels::condition_increments(each, increment, scratch.robots(), 1.0, scratch.increments(), log_weight,
                                    range);
    for (const auto& each : observations_) kernels::update_landmark(each, sensors, 1.0, nullptr, range);
  }

  fastslam::ParticleBlocks blocks_;
  fastslam::Particles particles_;
  fastslam::LandmarkStore store_;
  std::array<kernels::LandmarkObservation, kObservations> observations_;
};

class FastSlamBench {
 public:
  FastSlamBench(const FastSlamPlan& plan, const BenchProgress& progress) : plan_(plan), progress_(progress) {}

  std::vector<BenchResult> measure() {
    const std::array jobs{&FastSlamBench::updates, &FastSlamBench::steps, &FastSlamBench::resamplings,
                          &FastSlamBench::many};
    for (std::size_t i = 0; i < jobs.size(); ++i) {
      (this->*jobs[i])();
      progress_(static_cast<double>(i + 1) / static_cast<double>(jobs.size()));
    }
    return std::move(results_);
  }

 private:
  /// One landmark of one particle, weight included; then with all else that the block does: the draw of
  /// poses, the weights.
  void updates() {
    const SyntheticRun run =
        make_synthetic_run(100, kObservations, static_cast<int>(plan_.rounds) * plan_.steps);
    for (const ProposalKind proposal : {ProposalKind::kMotion, ProposalKind::kObservations})
      for (const Kind kind : {Kind::kRangeBearing, Kind::kRange, Kind::kBearing}) {
        LandmarkUpdates landmarks(plan_.particles, kind);
        const double kernel_ns = median_of_rounds(
            plan_.rounds, [&](std::size_t) { return landmarks.time_ns(proposal, plan_.steps); });
        results_.push_back({"fastslam.update", update_params(proposal, kind), kernel_ns, "ns"});
        results_.push_back(
            {"fastslam.update_block", update_params(proposal, kind), block_ns(run, proposal, kind), "ns"});
      }
  }

  [[nodiscard]] double block_ns(const SyntheticRun& run, ProposalKind proposal, Kind kind) const {
    const auto filter = start_filter(run, {.proposal = proposal, .particles = plan_.particles});
    return median_of_rounds(plan_.rounds, [&](std::size_t round) {
      const Duration before = spent(filter->blocks(), "update");
      for (const auto& step : round_of(run, round)) {
        filter->predict(step.motion);
        filter->correct(of_kind(kind, step.observations));
      }
      return 1e9 * to_seconds(spent(filter->blocks(), "update") - before) /
             (static_cast<double>(plan_.steps) * plan_.particles * kObservations);
    });
  }

  [[nodiscard]] nlohmann::ordered_json update_params(ProposalKind proposal, Kind kind) const {
    return {{"proposal", name_of(proposal)}, {"observe", name_of(kind)}, {"particles", plan_.particles}};
  }

  /// Whole steps in a large map, in turn with the plain filter's.
  void steps() {
    const int landmarks = plan_.maps[2];
    const SyntheticRun run =
        make_synthetic_run(landmarks, kObservations, static_cast<int>(plan_.rounds) * plan_.steps);
    const auto first = start_filter(run, {.proposal = ProposalKind::kMotion, .particles = plan_.particles});
    const auto second = start_filter(run, {.particles = plan_.particles});
    PlainFastSlam plain(plan_.particles, run.first_look);
    std::array<std::vector<double>, 3> rounds_ms;
    for (std::size_t round = 0; round < plan_.rounds; ++round) {
      const auto steps = round_of(run, round);
      rounds_ms[0].push_back(step_ms(steps, [&](const auto& s) { advance(*first, s); }));
      rounds_ms[1].push_back(step_ms(steps, [&](const auto& s) { advance(*second, s); }));
      // The plain step copies whole maps: a few of them tell.
      rounds_ms[2].push_back(
          step_ms(steps.first(2), [&](const auto& s) { plain.step(s.motion, s.observations); }));
    }
    const std::array names{"1.0", "2.0", "plain 1.0"};
    for (std::size_t i = 0; i < names.size(); ++i)
      results_.push_back({i < 2 ? "fastslam.step" : "fastslam.plain_step", step_params(names[i], landmarks),
                          *eval::median(rounds_ms[i]), "ms"});
    std::vector<double> ratios;
    for (std::size_t round = 0; round < plan_.rounds; ++round)
      ratios.push_back(rounds_ms[2][round] / rounds_ms[0][round]);
    results_.push_back(
        {"fastslam.plain_step_ratio", step_params("1.0", landmarks), *eval::median(ratios), "x"});
  }

  /// Resampling at every step, of few particles, so that the largest map fits into memory.
  void resamplings() {
    constexpr int kParticles = 100;
    for (const int landmarks : plan_.maps) {
      const SyntheticRun run =
          make_synthetic_run(landmarks, kObservations, static_cast<int>(plan_.rounds) * plan_.steps);
      const auto filter =
          start_filter(run, {.particles = kParticles, .resample_below = 1.0, .enkf_above = 1e9});
      const double us = median_of_rounds(plan_.rounds, [&](std::size_t round) {
        const Duration before = spent(filter->blocks(), "resample");
        for (const auto& step : round_of(run, round)) advance(*filter, step);
        return 1e6 * to_seconds(spent(filter->blocks(), "resample") - before) / plan_.steps;
      });
      results_.push_back(
          {"fastslam.resample",
           {{"particles", kParticles}, {"landmarks", landmarks}, {"observations", kObservations}},
           1e-3 * us,
           "ms"});
    }
  }

  /// As many particles as a small computer has memory for, on two threads; every second step resamples.
  void many() {
    if (plan_.many == 0) return;
    constexpr int kLandmarks = 20;
    constexpr int kSeen = 5;
    constexpr int kThreads = 2;
    constexpr int kSteps = 10;
    const SyntheticRun run = make_synthetic_run(kLandmarks, kSeen, static_cast<int>(plan_.rounds) * kSteps);
    const auto filter = start_filter(
        run, {.proposal = ProposalKind::kMotion, .particles = plan_.many, .resample_below = 0.3}, kThreads);
    const std::int64_t resamplings = filter->resamplings();
    const double per_second = median_of_rounds(plan_.rounds, [&](std::size_t round) {
      const Duration before = wall_time();
      for (const auto& step : std::span(run.steps).subspan(round * kSteps, kSteps)) advance(*filter, step);
      return kSteps / to_seconds(wall_time() - before);
    });
    const double resampled =
        static_cast<double>(filter->resamplings() - resamplings) / static_cast<double>(plan_.rounds * kSteps);
    results_.push_back({"fastslam.many",
                        {{"particles", plan_.many},
                         {"landmarks", kLandmarks},
                         {"observations", kSeen},
                         {"threads", kThreads},
                         {"resampled", resampled}},
                        per_second,
                        "1/s"});
  }

  static void advance(FastSlam& filter, const SyntheticRun::Step& step) {
    filter.predict(step.motion);
    filter.correct(step.observations);
  }

  template <class Step>
  static double step_ms(std::span<const SyntheticRun::Step> steps, const Step& step) {
    std::vector<double> times_ms;
    for (const auto& each : steps) {
      const Duration start = thread_cpu_time();
      step(each);
      times_ms.push_back(1e3 * to_seconds(thread_cpu_time() - start));
    }
    return *eval::median(times_ms);
  }

  [[nodiscard]] nlohmann::ordered_json step_params(const char* proposal, int landmarks) const {
    return {{"proposal", proposal},
            {"particles", plan_.particles},
            {"landmarks", landmarks},
            {"observations", kObservations}};
  }

  [[nodiscard]] std::span<const SyntheticRun::Step> round_of(const SyntheticRun& run,
                                                             std::size_t round) const {
    const auto steps = static_cast<std::size_t>(plan_.steps);
    return std::span(run.steps).subspan(round * steps, steps);
  }

  FastSlamPlan plan_;
  const BenchProgress& progress_;
  std::vector<BenchResult> results_;
};

}  // namespace

std::vector<BenchResult> bench_fastslam(const Machine& /*machine*/, BenchScope scope,
                                        const BenchProgress& progress) {
  return FastSlamBench(fastslam_plan(scope), progress).measure();
}

}  // namespace waymark::app
