#include "ekf_bench.hpp"

#include <array>
#include <chrono>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <utility>

#include "waymark/core/function_blocks.hpp"
#include "waymark/ekf/ekf_slam.hpp"

#include "plain_ekf.hpp"
#include "synthetic_run.hpp"
#include "wall_time.hpp"
#include "workbench/eval/median.hpp"

namespace waymark::app {
namespace {

/// One map size: as many steps per round as give a steady median in bearable time.
struct Size {
  int landmarks;
  std::size_t steps_per_round;
  bool textbook;    ///< O(n^3): only where it ends soon
  bool threads;     ///< large enough for a second thread
  bool compressed;  ///< large enough for a submap of its own
};
constexpr std::array kSizes{Size{50, 200, true, false, false}, Size{200, 100, false, false, true},
                            Size{1000, 20, false, true, true}, Size{2000, 8, false, true, true}};
constexpr std::array kQuickSizes{Size{50, 20, true, false, false}, Size{200, 10, false, true, true}};

struct EkfPlan {
  std::span<const Size> sizes;
  std::size_t rounds;
};

EkfPlan ekf_plan(BenchScope scope) {
  return scope == BenchScope::kQuick ? EkfPlan{kQuickSizes, 3} : EkfPlan{kSizes, 7};
}

/// One way to make the step, and its median step time of every round so far.
struct Contender {
  std::string name;
  nlohmann::ordered_json params;
  std::function<void(const SyntheticRun::Step&)> step;
  Duration (*clock)() = thread_cpu_time;
  std::vector<double> rounds_ms;

  void run_round(std::span<const SyntheticRun::Step> steps) {
    std::vector<double> times_ms;
    for (const auto& each : steps) {
      const Duration start = clock();
      step(each);
      times_ms.push_back(1e3 * to_seconds(clock() - start));
    }
    rounds_ms.push_back(*eval::median(times_ms));
  }

  [[nodiscard]] BenchResult result() const { return {name, params, *eval::median(rounds_ms), "ms"}; }
};

std::shared_ptr<EkfSlam> start_filter(const SyntheticRun& run, ekf::Consistency mode, int threads = 1,
                                      Compress compressed = Compress::kNever) {
  const EkfOptions options{
      .consistency = mode, .capacity = static_cast<int>(run.first_look.size()), .compressed = compressed};
  auto filter = std::make_shared<EkfSlam>(options, LandmarkSensor{}, threads);
  filter->predict(run.start);
  filter->correct(run.first_look);
  return filter;
}

Contender ours(const std::string& name, nlohmann::ordered_json params, std::shared_ptr<EkfSlam> filter) {
  return {name, std::move(params), [filter](const SyntheticRun::Step& step) {
            filter->predict(step.motion);
            filter->correct(step.observations);
          }};
}

Contender plain(const std::string& name, nlohmann::ordered_json params, PlainEkf::Form form,
                const SyntheticRun& run) {
  auto filter = std::make_shared<PlainEkf>(form, run.start, run.first_look);
  return {name, std::move(params),
          [filter](const SyntheticRun::Step& step) { filter->step(step.motion, step.observations); }};
}

/// How often the step of `slow` fits into that of `fast`: the median over rounds of the ratio within a round,
/// so that whatever else the machine did meanwhile hits both.
double ratio(const Contender& slow, const Contender& fast) {
  std::vector<double> ratios;
  for (std::size_t i = 0; i < slow.rounds_ms.size(); ++i)
    ratios.push_back(slow.rounds_ms[i] / fast.rounds_ms[i]);
  return *eval::median(ratios);
}

nlohmann::ordered_json with(nlohmann::ordered_json params, const char* key,
                            const nlohmann::ordered_json& value) {
  params[key] = value;
  return params;
}

/// The function-block table of one filter, without the first look.
void append_blocks(std::vector<BenchResult>& results, const nlohmann::ordered_json& params,
                   const FunctionBlocks& start, const FunctionBlocks& end) {
  for (std::size_t i = 0; i < end.rows().size(); ++i) {
    const auto& row = end.rows()[i];
    const auto calls = static_cast<double>(row.calls - start.rows()[i].calls);
    const double spent_us = 1e6 * to_seconds(row.total - start.rows()[i].total);
    results.push_back({"ekf.block", with(params, "block", std::string(row.name)), spent_us / calls, "us"});
  }
}

class SizeBench {
 public:
  SizeBench(const Size& size, std::size_t rounds, const Machine& machine)
      : size_(size),
        rounds_(rounds),
        machine_(machine),
        run_(make_synthetic_run(size.landmarks, kObservations,
                                static_cast<int>(rounds * size.steps_per_round))) {}

  std::vector<BenchResult> measure(const BenchProgress& progress) {
    const auto invariant = start_filter(run_, ekf::Consistency::kInvariant);
    contend(invariant);
    const FunctionBlocks start = invariant->blocks();
    for (std::size_t round = 0; round < rounds_; ++round) {
      const auto steps = std::span(run_.steps).subspan(round * size_.steps_per_round, size_.steps_per_round);
      for (Contender& contender : contenders_) contender.run_round(steps);
      progress(static_cast<double>(round + 1) / static_cast<double>(rounds_));
    }
    std::vector<BenchResult> results;
    for (const Contender& contender : contenders_) results.push_back(contender.result());
    append_comparisons(results);
    append_blocks(results, params_, start, invariant->blocks());
    return results;
  }

 private:
  /// The invariant filter first: the others are compared with it.
  void contend(const std::shared_ptr<EkfSlam>& invariant) {
    contenders_.push_back(ours("ekf.step", with(params_, "mode", "invariant"), invariant));
    contenders_.push_back(
        ours("ekf.step", with(params_, "mode", "standard"), start_filter(run_, ekf::Consistency::kStandard)));
    for (const auto& [name, mode] : {std::pair{"compressed invariant", ekf::Consistency::kInvariant},
                                     std::pair{"compressed standard", ekf::Consistency::kStandard}})
      if (size_.compressed)
        contenders_.push_back(
            ours("ekf.step", with(params_, "mode", name), start_filter(run_, mode, 1, Compress::kAlways)));
    contenders_.push_back(plain("ekf.plain_rank_update", params_, PlainEkf::Form::kRankUpdate, run_));
    if (size_.textbook)
      contenders_.push_back(plain("ekf.plain_textbook", params_, PlainEkf::Form::kTextbook, run_));
    for (const int threads : {1, 2}) {
      if (!size_.threads) continue;
      contenders_.push_back(ours("ekf.step_wall", with(params_, "threads", threads),
                                 start_filter(run_, ekf::Consistency::kInvariant, threads)));
      contenders_.back().clock = wall_time;
    }
  }

  void append_comparisons(std::vector<BenchResult>& results) const {
    const Contender& invariant = contenders_.front();
    for (const Contender& contender : contenders_)
      if (contender.name.starts_with("ekf.plain"))
        results.push_back({contender.name + "_ratio", params_, ratio(contender, invariant), "x"});
    const double n = 3.0 + 2.0 * size_.landmarks;
    const double bound_ms = n * n * 2.0 * kObservations / (machine_.fma_gflops * 1e6);
    results.push_back({"ekf.flop_bound", params_, bound_ms, "ms"});
    results.push_back({"ekf.flop_bound_distance", params_, invariant.result().value / bound_ms, "x"});
  }

  Size size_;
  std::size_t rounds_;
  const Machine& machine_;
  SyntheticRun run_;
  nlohmann::ordered_json params_{{"landmarks", size_.landmarks}, {"observations", kObservations}};
  std::vector<Contender> contenders_;
};

}  // namespace

std::vector<BenchResult> bench_ekf(const Machine& machine, BenchScope scope, const BenchProgress& progress) {
  const auto [sizes, rounds] = ekf_plan(scope);
  std::vector<BenchResult> results;
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    SizeBench bench(sizes[i], rounds, machine);
    const auto part = [&, i, count = static_cast<double>(sizes.size())](double fraction) {
      progress((static_cast<double>(i) + fraction) / count);
    };
    for (auto& result : bench.measure(part)) results.push_back(std::move(result));
  }
  return results;
}

}  // namespace waymark::app
