#include "workshop/figures/budget.hpp"

#include <array>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <memory>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "waymark/core/threads.hpp"

#include "workbench/eval/evaluate.hpp"
#include "workbench/logs/event_list.hpp"
#include "workbench/run/recording_figures.hpp"
#include "workshop/figures/over_runs.hpp"

namespace waymark {
namespace {

constexpr const char* kRoom = "sim:room";
constexpr std::array kParts{1.0, 0.5, 0.2, 0.1};  // of the work that a run would like to do

struct BudgetRequest {
  double minutes = 10.0;
  double budget_ms = 5.0;
  int seeds = 8;
  std::vector<std::string> settings;

  [[nodiscard]] UserSettings with(std::vector<std::string> more) const {
    more.insert(more.begin(), settings.begin(), settings.end());
    return {{}, std::move(more)};
  }
};

/// Keeps a core busy as long as it lives.
class BusyCore {
 public:
  BusyCore() = default;
  BusyCore(const BusyCore&) = delete;
  BusyCore& operator=(const BusyCore&) = delete;
  ~BusyCore() {
    stop_ = true;
    for (auto& thread : threads_) thread.join();
  }

 private:
  std::atomic<bool> stop_{false};
  std::vector<std::thread> threads_ = start_threads(
      1,
      [this] {
        while (!stop_) {
        }
      },
      [] {});
};

/// Minutes of images by the clock, with every frame that took longer than it may.
Result<void> keep_to_the_clock(const BudgetRequest& request) {
  constexpr double kShortestLap_s = 40.0;
  const int laps = static_cast<int>(std::ceil(60.0 * request.minutes / kShortestLap_s));
  const auto opened =
      open_input(kRoom, request.with({fmt::format("sim.laps={}", laps), "tracker.budget=clock",
                                      fmt::format("tracker.frame_budget_ms={}", request.budget_ms)}));
  if (!opened) return opened.error();
  const BusyCore other;
  const auto recording = record(*opened->source, opened->config, {.to_s = 60.0 * request.minutes});
  if (!recording) return recording.error();
  const StepTimes times = step_times(recording->steps);
  fmt::print("{} images with {} ms each by the clock, another core busy: {} took longer\n",
             recording->counts.images, request.budget_ms, deadline_misses(*recording));
  fmt::print("thread CPU per image, ms: p50 {:.3f}, p99 {:.3f}, p99.9 {:.3f}, largest {:.3f}\n",
             1e-3 * times.p50_us, 1e-3 * times.p99_us, 1e-3 * times.p999_us, 1e-3 * times.max_us);
  for (const auto& note : recording->notes) fmt::print("  note: {}\n", note);
  return {};
}

/// A drive held in memory, to be run several times.
struct Drive {
  LogInfo info;
  Config config;
  std::vector<Event> events;
};

Result<Drive> render(const BudgetRequest& request, int seed) {
  auto opened = open_input(kRoom, request.with({fmt::format("seed={}", seed), "tracker.budget=work"}));
  if (!opened) return opened.error();
  Drive drive{opened->source->info(), opened->config, {}};
  while (true) {
    auto event = opened->source->next();
    if (!event) return event.error();
    if (!*event) return drive;
    drive.events.push_back(std::move(**event));
  }
}

struct BudgetRun {
  double rmse_m = NAN;
  double hurried = NAN;  ///< part of the images in which something was left out
};

BudgetRun run(const Drive& drive, double budget_ms) {
  Config config = drive.config;
  config.tracker.budget.per_frame_ms = budget_ms;
  EventList source(drive.info, drive.events);
  const auto recording = record(source, config);
  if (!recording) return {};
  std::vector<eval::TruthSample> truth;
  for (const auto& [stamp, sample] : recording->truth) truth.push_back({stamp, sample});
  const auto score = eval::score_path(recording->trajectory, eval::TruthTrack(std::move(truth)));
  const vision::TrackerCounts& counts = recording->tracker;
  return {score.position_rmse_m.value_or(NAN),
          static_cast<double>(counts.out_of_budget) / static_cast<double>(counts.images)};
}

/// The least work per image with which nothing is left out in 99 of 100 images, to a twentieth.
double wanted_ms(const Drive& drive) {
  double low_ms = 0.01;
  double high_ms = 100.0;
  while (high_ms > 1.05 * low_ms) {
    const double middle_ms = std::sqrt(low_ms * high_ms);
    (run(drive, middle_ms).hurried > 0.01 ? low_ms : high_ms) = middle_ms;
  }
  return high_ms;
}

/// The same drives with the work that they would like to do, and with less.
Result<void> starve(const BudgetRequest& request) {
  const auto first = render(request, 1);
  if (!first) return first.error();
  const double wanted = wanted_ms(*first);
  std::array<std::vector<BudgetRun>, kParts.size()> runs;
  runs.fill(std::vector<BudgetRun>(static_cast<std::size_t>(request.seeds)));
  for_all_runs(request.seeds, [&](int i) {
    const auto drive = render(request, i + 1);
    for (std::size_t part = 0; drive && part < kParts.size(); ++part)
      runs[part][static_cast<std::size_t>(i)] = run(*drive, kParts[part] * wanted);
  });
  fmt::print("\n{}, {} seeds, work counted at fixed costs; position RMSE in m\n", kRoom, request.seeds);
  fmt::print("{:<12}{:>12}{:>14}{:>10}{:>10}{:>16}{:>10}\n", "of wanted", "budget ms", "left out, %", "mean",
             "median", "against wanted", "");
  for (std::size_t part = 0; part < kParts.size(); ++part)
    fmt::print("{:<12}{:>12.3f}{:>14.1f}{:>10.3f}{:>10.3f}{:>16.2f}{:>10.2f}\n", kParts[part],
               kParts[part] * wanted, 100.0 * mean(runs[part], &BudgetRun::hurried),
               mean(runs[part], &BudgetRun::rmse_m), median(runs[part], &BudgetRun::rmse_m),
               mean(runs[part], &BudgetRun::rmse_m) / mean(runs[0], &BudgetRun::rmse_m),
               median(runs[part], &BudgetRun::rmse_m) / median(runs[0], &BudgetRun::rmse_m));
  return {};
}

int budget(const BudgetRequest& request) {
  for (const auto& part : {keep_to_the_clock, starve}) {
    const auto done = part(request);
    if (!done) fmt::print(stderr, "{}\n", done.error().message);
    if (!done) return 1;
  }
  return 0;
}

}  // namespace

void add_budget(CLI::App& app, int& status) {
  auto* command = app.add_subcommand("budget", "time per image, and accuracy with a smaller frame budget");
  auto request = std::make_shared<BudgetRequest>();
  command->add_option("--minutes", request->minutes, "of images against the clock")
      ->check(CLI::PositiveNumber);
  command->add_option("--budget-ms", request->budget_ms, "of an image")->check(CLI::PositiveNumber);
  command->add_option("--seeds", request->seeds, "of runs with less time")->check(CLI::PositiveNumber);
  command->add_option("--set", request->settings, "config key=value")->allow_extra_args(false);
  command->callback([request, &status] { status = budget(*request); });
}

}  // namespace waymark
