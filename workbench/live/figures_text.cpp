#include "workbench/live/figures_text.hpp"

#include <sys/resource.h>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "workbench/logs/json_text.hpp"

namespace waymark::live {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kFrame_s = 0.033;  // of a camera of 30 Hz

std::string row(const char* what, const LatencyHistogram& times) {
  if (times.count() == 0) return "";
  return fmt::format("  {:<34}{:>9}{:>9.3f}{:>9.3f}{:>9.3f}{:>9.3f}\n", what, times.count(),
                     1e3 * times.quantile_s(0.5), 1e3 * times.quantile_s(0.99), 1e3 * times.quantile_s(0.999),
                     1e3 * times.max_s());
}

std::string row(const StreamSummary& s) {
  std::string text = fmt::format("  {:<34}{:>9}{:>8.1f} Hz   age {:.1f} ms, 99 %: {:.1f} ms", s.name,
                                 s.received, s.rate_hz, 1e3 * s.age_p50_s, 1e3 * s.age_p99_s);
  const auto add = [&text](std::int64_t count, const char* what) {
    if (count > 0) text += fmt::format(", {} {}", count, what);
  };
  add(s.bad, "damaged");
  add(s.lost, "lost");
  add(s.replaced, "images replaced by newer ones");
  add(s.dropped, "dropped: no room");
  add(s.reconnects, "reconnected");
  add(s.clock_steps, "steps of its clock");
  if (!s.fault.empty()) text += "; " + s.fault;
  return text + "\n";
}

Json to_json(const LatencyHistogram& times) {
  return {{"count", times.count()},
          {"p50_ms", 1e3 * times.quantile_s(0.5)},
          {"p99_ms", 1e3 * times.quantile_s(0.99)},
          {"p999_ms", 1e3 * times.quantile_s(0.999)},
          {"max_ms", 1e3 * times.max_s()}};
}

Json to_json(const StreamSummary& s) {
  return {{"name", s.name},
          {"received", s.received},
          {"rate_hz", s.rate_hz},
          {"age_p50_ms", 1e3 * s.age_p50_s},
          {"age_p99_ms", 1e3 * s.age_p99_s},
          {"damaged", s.bad},
          {"lost", s.lost},
          {"replaced", s.replaced},
          {"dropped", s.dropped},
          {"reconnects", s.reconnects},
          {"clock_steps", s.clock_steps},
          {"fault", s.fault}};
}

}  // namespace

ProcessFigures process_figures() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return {usage.ru_majflt, usage.ru_nivcsw};
}

std::string to_text(const SessionFigures& figures, const PipelineCounts& counts,
                    const ProcessFigures& process) {
  std::string text = fmt::format("  {:<34}{:>9}{:>9}{:>9}{:>9}{:>9}\n", "latencies in ms", "count", "50 %",
                                 "99 %", "99.9 %", "largest");
  text += row("odometry in to pose of now", figures.pose_latencies);
  text += row("observed to odometry of its moment", figures.correction_waits);
  text += row("both there to corrected pose", figures.correction_latencies);
  text += fmt::format("  over a frame of 33 ms: {}; late events: {}; major faults: {}; switched away: {}\n",
                      figures.correction_latencies.count_above(kFrame_s), counts.late, process.major_faults,
                      process.involuntary_switches);
  for (const StreamSummary& stream : figures.streams) text += row(stream);
  return text;
}

std::string to_json(const SessionFigures& figures, const PipelineCounts& counts,
                    const ProcessFigures& process) {
  Json streams = Json::array();
  for (const StreamSummary& stream : figures.streams) streams.push_back(to_json(stream));
  const Json json{{"pose_of_now", to_json(figures.pose_latencies)},
                  {"wait_for_odometry", to_json(figures.correction_waits)},
                  {"correction", to_json(figures.correction_latencies)},
                  {"missed_frames", figures.correction_latencies.count_above(kFrame_s)},
                  {"late_events", counts.late},
                  {"major_faults", process.major_faults},
                  {"involuntary_switches", process.involuntary_switches},
                  {"streams", streams}};
  return json_text(json, 2) + "\n";
}

}  // namespace waymark::live
