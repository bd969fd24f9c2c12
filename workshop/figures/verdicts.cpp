#include "workshop/figures/verdicts.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "workbench/run/verdict.hpp"
#include "workbench/study/scored_run.hpp"
#include "workshop/figures/over_runs.hpp"

namespace waymark {
namespace {

struct VerdictsRequest {
  int pairs = 500;
  int first_seed = 1;
};

/// What the log of a pair is like.
struct DrivenScene {
  std::string world;
  std::string filter;
  int seed = 1;
  double duration_s = 0.0;  ///< of the twin

  /// A moment in the middle three fifths of the log, another one for each seed.
  [[nodiscard]] double some_time_s() const {
    return duration_s * (0.2 + 0.6 * std::fmod(0.618034 * seed, 1.0));
  }
};

/// A log of which some events are changed, or left out where `change` says false.
class ChangedSource final : public Source {
 public:
  using Change = std::function<bool(Event&)>;
  ChangedSource(std::unique_ptr<Source> source, Change change)
      : source_(std::move(source)), change_(std::move(change)) {}
  [[nodiscard]] const LogInfo& info() const override { return source_->info(); }
  [[nodiscard]] Result<std::optional<Event>> next() override {
    for (;;) {
      auto event = source_->next();
      if (!event || !*event || change_(**event)) return event;
    }
  }

 private:
  std::unique_ptr<Source> source_;
  Change change_;
};

/// One fault: keys of the simulator, what is wrong in the config, what is wrong in the log.
struct Fault {
  const char* name;
  bool in_rooms;  ///< whether it can be given to a camera in a room
  std::vector<std::string> (*settings)(const DrivenScene&) = [](const DrivenScene&) {
    return std::vector<std::string>{};
  };
  void (*misconfigure)(Config&) = [](Config&) {};
  bool (*change)(Event&, const DrivenScene&) = nullptr;
};

std::vector<std::string> at_some_time(const char* key, const DrivenScene& scene) {
  return {fmt::format("{}={}", key, scene.some_time_s())};
}

/// As if every standard deviation were so many times as large.
void scale_sigmas(Config& config, double factor) {
  LandmarkSensor& sensor = config.sensor;
  for (double* sigma :
       {&sensor.range_sigma_m, &sensor.range_sigma_ratio, &sensor.bearing_sigma_deg,
        &config.markers.side_sigma_px, &config.markers.corner_sigma_px, &config.markers.jitter_deg})
    *sigma *= factor;
  OdometryNoise& noise = config.odometry.noise;
  for (double* variance :
       {&noise.wheel_var_m2_per_m, &noise.forward_var_m2_per_m, &noise.lateral_var_m2_per_m,
        &noise.turn_var_rad2_per_rad, &noise.turn_var_rad2_per_m})
    *variance *= factor * factor;
}

bool flip_bearings(Event& event, const DrivenScene&) {
  auto* const observations = std::get_if<Observations>(&event.content);
  if (observations == nullptr) return true;
  for (Observation& observation : *observations)
    if (auto* both = std::get_if<RangeBearing>(&observation.value)) both->bearing_rad = -both->bearing_rad;
  return true;
}

bool leave_gap(Event& event, const DrivenScene& scene) {
  if (!std::holds_alternative<Observations>(event.content) && !std::holds_alternative<Image>(event.content))
    return true;
  const double since_s = to_seconds(event.stamp - stamp_from_seconds(scene.some_time_s()));
  return since_s < 0.0 || since_s > 10.0;
}

const std::array kFaults{
    Fault{"false first observation", false,
          [](const DrivenScene&) { return std::vector<std::string>{"sim.false_first_share=0.001"}; }},
    Fault{"5 % outliers", false,
          [](const DrivenScene&) { return std::vector<std::string>{"sim.outlier_share=0.05"}; }},
    Fault{"landmark carried", false,
          [](const DrivenScene& scene) { return at_some_time("sim.landmark_carried_at_s", scene); }},
    Fault{"robot carried", true,
          [](const DrivenScene& scene) { return at_some_time("sim.robot_carried_at_s", scene); }},
    Fault{.name = "wheels 10 % too large",
          .in_rooms = true,
          .misconfigure =
              [](Config& config) {
                config.odometry.wheels.left_radius_m *= 1.1;
                config.odometry.wheels.right_radius_m *= 1.1;
              }},
    Fault{.name = "bearing sign", .in_rooms = false, .change = flip_bearings},
    Fault{.name = "delay 0.3 s",
          .in_rooms = true,
          .misconfigure = [](Config& config) { config.sensor.delay_s += 0.3; }},
    Fault{.name = "gap of 10 s", .in_rooms = true, .change = leave_gap},
    Fault{.name = "sigmas x 3",
          .in_rooms = true,
          .misconfigure = [](Config& config) { scale_sigmas(config, 3.0); }},
    Fault{.name = "sigmas / 3",
          .in_rooms = true,
          .misconfigure = [](Config& config) { scale_sigmas(config, 1.0 / 3.0); }},
};

/// The run, with a fault or without.
std::optional<study::ScoredRun> run(const DrivenScene& scene, const Fault* fault) {
  std::vector<std::string> settings{"filter=" + scene.filter, fmt::format("seed={}", scene.seed),
                                    "fastslam.particles=150"};
  if (fault != nullptr) std::ranges::copy(fault->settings(scene), std::back_inserter(settings));
  auto opened = open_input("sim:" + scene.world, {{}, settings});
  if (!opened) {
    fmt::print(stderr, "{}: {}\n", scene.world, opened.error().message);
    return std::nullopt;
  }
  if (fault != nullptr) fault->misconfigure(opened->config);
  if (fault != nullptr && fault->change != nullptr)
    opened->source = std::make_unique<ChangedSource>(
        std::move(opened->source), [&](Event& event) { return fault->change(event, scene); });
  auto recording = record(*opened->source, opened->config);
  if (!recording) {
    fmt::print(stderr, "{}: {}\n", scene.world, recording.error().message);
    return std::nullopt;
  }
  return study::score_run(scene.world, opened->config, opened->source->info(), *std::move(recording));
}

/// What is kept of a run.
struct JudgedRun {
  double rmse_m = NAN;
  double odometry_rmse_m = NAN;
  Verdict verdict;  ///< without truth
};

JudgedRun judge_run(const study::ScoredRun& run) {
  return {run.evaluation->path.position_rmse_m.value_or(NAN),
          run.evaluation->odometry.position_rmse_m.value_or(NAN), judge(gather_evidence(run.recording))};
}

struct VerdictPair {
  DrivenScene scene;
  const Fault* fault = nullptr;
  JudgedRun clean;
  JudgedRun faulty;

  [[nodiscard]] bool is_wrong() const {
    return !(faulty.rmse_m <= 3.0 * clean.rmse_m) && !(faulty.rmse_m <= 0.05) &&
           !(faulty.rmse_m <= 0.5 * faulty.odometry_rmse_m);
  }
};

VerdictPair plan(const VerdictsRequest& request, int i) {
  constexpr std::array kWorlds{"study", "square", "forest"};
  constexpr int kOneRoomIn = 25;
  VerdictPair pair;
  const bool in_room = i % kOneRoomIn == kOneRoomIn - 1;
  const auto turn = static_cast<std::size_t>(i);
  pair.scene = {in_room ? "marker-room" : kWorlds[turn % 3], turn / 3 % 2 == 0 ? "ekf" : "fastslam",
                request.first_seed + i};
  std::vector<const Fault*> faults;
  for (const Fault& fault : kFaults)
    if (!in_room || fault.in_rooms) faults.push_back(&fault);
  pair.fault = faults[(in_room ? turn / kOneRoomIn : turn / 6) % faults.size()];
  return pair;
}

void make(VerdictPair& pair) {
  const auto clean = run(pair.scene, nullptr);
  if (!clean) return;
  pair.scene.duration_s = to_seconds(clean->recording.trajectory.back().stamp - Stamp{});
  pair.clean = judge_run(*clean);
  if (const auto faulty = run(pair.scene, pair.fault)) pair.faulty = judge_run(*faulty);
}

double percent(std::ptrdiff_t part, std::ptrdiff_t all) {
  return 100.0 * static_cast<double>(part) / static_cast<double>(std::max<std::ptrdiff_t>(1, all));
}

/// A fault, or all where there is none: how many of its runs are wrong, and what they are called.
void print_row(const char* name, const std::vector<VerdictPair>& pairs, const Fault* fault) {
  const auto count = [&](bool wrong, Trust level) {
    return std::ranges::count_if(pairs, [&](const VerdictPair& pair) {
      return (fault == nullptr || pair.fault == fault) && pair.is_wrong() == wrong &&
             pair.faulty.verdict.level == level;
    });
  };
  fmt::print("{:<26}", name);
  for (const bool wrong : {true, false})
    for (const Trust level : {Trust::kGood, Trust::kUnsure, Trust::kDoNotTrust})
      fmt::print("{:>9}", count(wrong, level));
  fmt::print("\n");
}

void print_list(const char* title, const std::vector<VerdictPair>& pairs,
                bool (*is_listed)(const VerdictPair&)) {
  fmt::print("{}\n", title);
  for (const VerdictPair& pair : pairs) {
    if (!is_listed(pair)) continue;
    fmt::print("  {} {} seed {}, {}: RMSE {:.3f} m, without {:.3f} m, odometry {:.3f} m\n", pair.scene.world,
               pair.scene.filter, pair.scene.seed, pair.fault->name, pair.faulty.rmse_m, pair.clean.rmse_m,
               pair.faulty.odometry_rmse_m);
    for (const std::string& reason : pair.clean.verdict.reasons)
      if (pair.clean.verdict.level != Trust::kGood) fmt::print("    without the fault: {}\n", reason);
  }
}

bool is_missed(const VerdictPair& pair) {
  return pair.is_wrong() && pair.faulty.verdict.level == Trust::kGood;
}
bool is_false_alarm(const VerdictPair& pair) { return pair.clean.verdict.level != Trust::kGood; }

void print_verdicts(const VerdictsRequest& request) {
  std::vector<VerdictPair> pairs;
  for (int i = 0; i < request.pairs; ++i) pairs.push_back(plan(request, i));
  for_all_runs(request.pairs, [&](int i) { make(pairs[static_cast<std::size_t>(i)]); });
  fmt::print("{:<26}{:>27}{:>27}\n{:<26}", "", "wrong and called", "right and called", "fault");
  for (int i = 0; i < 2; ++i) fmt::print("{:>9}{:>9}{:>9}", "good", "unsure", "not");
  fmt::print("\n");
  for (const Fault& fault : kFaults) print_row(fault.name, pairs, &fault);
  print_row("all", pairs, nullptr);
  const auto wrong = std::ranges::count_if(pairs, &VerdictPair::is_wrong);
  const auto missed = std::ranges::count_if(pairs, is_missed);
  const auto good = request.pairs - std::ranges::count_if(pairs, is_false_alarm);
  fmt::print("wrong runs called good: {} of {} ({:.1f} %)\n", missed, wrong, percent(missed, wrong));
  fmt::print("runs without fault called good: {} of {} ({:.1f} %)\n", good, request.pairs,
             percent(good, request.pairs));
  print_list("wrong, but called good:", pairs, is_missed);
  print_list("without fault, but not called good:", pairs, is_false_alarm);
}

}  // namespace

void add_verdicts(CLI::App& app) {
  auto request = std::make_shared<VerdictsRequest>();
  auto* command = app.add_subcommand("verdicts", "what the verdict says of runs with a fault and without");
  command->add_option("--pairs", request->pairs)->check(CLI::PositiveNumber);
  command->add_option("--first", request->first_seed, "the first of the seeds")->check(CLI::PositiveNumber);
  command->callback([request] { print_verdicts(*request); });
}

}  // namespace waymark
