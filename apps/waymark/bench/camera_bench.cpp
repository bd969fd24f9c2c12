#include "camera_bench.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <string>
#include <utility>

#include "waymark/core/function_blocks.hpp"
#include "waymark/kernels/zmssd.hpp"
#include "waymark/vision/corners.hpp"

#include "workbench/config/known_settings.hpp"
#include "workbench/eval/median.hpp"
#include "workbench/logs/event_list.hpp"
#include "workbench/report/article_times.hpp"
#include "workbench/run/recording.hpp"
#include "workbench/run/recording_figures.hpp"

namespace waymark::app {
namespace {

constexpr const char* kRoom = "sim:room";

struct CameraPlan {
  double drive_s;
  std::size_t rounds;
  int repetitions;  ///< of a kernel in a round
};

CameraPlan camera_plan(BenchScope scope) {
  return scope == BenchScope::kQuick ? CameraPlan{4.0, 3, 10} : CameraPlan{24.0, 7, 50};
}

/// A drive held in memory, images and all.
struct Drive {
  LogInfo info;
  Config config;
  std::vector<Event> events;

  [[nodiscard]] const GreyImage& last_image() const {
    const auto last = std::find_if(events.rbegin(), events.rend(), [](const Event& event) {
      return std::holds_alternative<Image>(event.content);
    });
    return *std::get<Image>(last->content).pixels;
  }
};

Drive render(double drive_s, const BenchProgress& progress) {
  auto opened = std::move(*open_input(kRoom, {}));
  Drive drive{opened.source->info(), opened.config, {}};
  const Stamp end = stamp_from_seconds(drive_s);
  for (auto event = opened.source->next(); event && *event && (*event)->stamp <= end;
       event = opened.source->next()) {
    progress(to_seconds((*event)->stamp - Stamp{}) / drive_s);
    drive.events.push_back(std::move(**event));
  }
  return drive;
}

/// Median over rounds of the time for one of `count` pieces of work per call, s.
double time_s(const CameraPlan& plan, double count, const std::function<void()>& work) {
  std::vector<double> rounds;
  for (std::size_t round = 0; round < plan.rounds; ++round) {
    const Duration start = thread_cpu_time();
    for (int i = 0; i < plan.repetitions; ++i) work();
    rounds.push_back(to_seconds(thread_cpu_time() - start) / (plan.repetitions * count));
  }
  return *eval::median(rounds);
}

void append_corners(std::vector<BenchResult>& results, const CameraPlan& plan, const GreyImage& image) {
  for (const int arc : {9, 12}) {
    vision::CornerDetector detector({.arc = arc});
    const double spent_s = time_s(plan, 1.0, [&] { (void)detector.detect(image); });
    results.push_back({"camera.fast",
                       {{"arc", arc}, {"width", image.width_px()}, {"height", image.height_px()}},
                       1e6 * spent_s,
                       "us"});
  }
}

/// The windows of a circle: what a search ellipse of the usual size takes.
std::vector<kernels::WindowRow> circle(int radius) {
  std::vector<kernels::WindowRow> rows;
  for (int v = -radius; v <= radius; ++v) {
    const int half = static_cast<int>(std::sqrt(radius * radius - v * v));
    rows.push_back({radius - half, 2 * half + 1});
  }
  return rows;
}

void append_zmssd(std::vector<BenchResult>& results, const CameraPlan& plan, const Machine& machine,
                  const GreyImage& image) {
  const auto rows = circle(12);
  int windows = 0;
  for (const auto& row : rows) windows += row.count;
  std::vector<std::uint32_t> scores(static_cast<std::size_t>(windows));
  const std::array targets{std::pair{machine.instruction_set, &kernels::zmssd_search},
                           std::pair{std::string("scalar"), &kernels::reference::zmssd_search}};
  for (const int size : {8, 16}) {
    const auto patch = kernels::make_zmssd_patch(image.view().pixel(150, 100), image.stride(), size);
    for (const auto& [target, search] : targets) {
      const double spent_s = time_s(plan, windows, [&, run = search] {
        run(patch, image.view().pixel(140, 90), image.stride(), rows.data(), rows.size(), scores.data());
      });
      results.push_back({"camera.zmssd", {{"patch", size}, {"target", target}}, 1e9 * spent_s, "ns"});
    }
  }
}

Recording run(const Drive& drive, const Config& config) {
  EventList source(drive.info, drive.events);
  return std::move(*record(source, config));
}

Config article_mode(const Drive& drive) {
  Config config = drive.config;
  Schema schema = describe(config);
  const auto settings = known_settings("vincke2012");
  for (const auto& [key, value] : *settings) (void)schema.set(key, value, "configs/vincke2012.yaml");
  return config;
}

/// The second half of the drive: of a long one with full maps.
struct SecondHalf {
  StepTimes times;
  double mean_matched;

  explicit SecondHalf(const Recording& recording) {
    const auto& steps = recording.steps;
    const std::vector late(steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2), steps.end());
    times = step_times(late);
    const auto matched = std::ranges::count_if(recording.innovations, [&late](const auto& each) {
      return each.stamp >= late.front().stamp && each.innovation.outcome == Outcome::kMatched;
    });
    mean_matched = static_cast<double>(matched) / static_cast<double>(late.size());
  }
};

/// Frames of the second half, and blocks per frame of the whole drive.
void append_mode(std::vector<BenchResult>& results, const std::string& mode, const Recording& recording) {
  const SecondHalf late(recording);
  const auto landmarks = recording.filter->snapshot().landmarks.size();
  const double matched = std::round(10.0 * late.mean_matched) / 10.0;
  for (const auto& [quantile, us] :
       {std::pair{"p50", late.times.p50_us}, std::pair{"p99.9", late.times.p999_us}})
    results.push_back(
        {"camera.frame",
         {{"landmarks", landmarks}, {"matched", matched}, {"mode", mode}, {"quantile", quantile}},
         1e-3 * us,
         "ms"});
  for (const auto& row : recording.blocks)
    results.push_back({"camera.block",
                       {{"block", std::string(row.name)}, {"mode", mode}},
                       1e6 * to_seconds(row.total) / static_cast<double>(recording.steps.size()),
                       "us"});
}

/// The table of the article beside ours.
void append_published(std::vector<BenchResult>& results, const Recording& recording) {
  for (const auto& row : recording.blocks)
    if (const auto time = article_time(row.name))
      results.push_back({"camera.block_published",
                         {{"block", std::string(row.name)}, {"machine", "ARM 500 MHz"}},
                         time->per_frame_us,
                         "us"});
  for (const auto& [machine, us] : {std::pair{"ARM 500 MHz", kArticleFrame_us},
                                    std::pair{"ARM 500 MHz, NEON and DSP", kArticleOptimisedFrame_us}})
    results.push_back({"camera.frame_published", {{"machine", machine}}, 1e-3 * us, "ms"});
}

}  // namespace

std::vector<BenchResult> bench_camera(const Machine& machine, BenchScope scope,
                                      const BenchProgress& progress) {
  const CameraPlan plan = camera_plan(scope);
  const Drive drive = render(plan.drive_s, [&](double fraction) { progress(0.6 * fraction); });
  std::vector<BenchResult> results;
  append_corners(results, plan, drive.last_image());
  append_zmssd(results, plan, machine, drive.last_image());
  progress(0.7);
  const Recording ours = run(drive, drive.config);
  append_mode(results, "default", ours);
  progress(0.85);
  const Recording article = run(drive, article_mode(drive));
  append_mode(results, "article", article);
  results.push_back({"camera.frame_ratio",
                     {{"of", "article"}, {"to", "default"}},
                     SecondHalf(article).times.p50_us / SecondHalf(ours).times.p50_us,
                     "x"});
  append_published(results, ours);
  progress(1.0);
  return results;
}

}  // namespace waymark::app
