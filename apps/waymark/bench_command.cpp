#include <algorithm>
#include <array>
#include <memory>
#include <string_view>

#include <fmt/format.h>

#include "bench/camera_bench.hpp"
#include "bench/ekf_bench.hpp"
#include "bench/fastslam_bench.hpp"
#include "bench/machine.hpp"
#include "commands.hpp"
#include "workbench/logs/json_text.hpp"

namespace waymark::app {
namespace {

struct Suite {
  const char* name;
  std::vector<BenchResult> (*run)(const Machine&, BenchScope, const BenchProgress&);
};
constexpr std::array kSuites{Suite{"ekf", bench_ekf}, Suite{"fastslam", bench_fastslam},
                             Suite{"camera", bench_camera}};

struct BenchRequest {
  std::vector<std::string> suites;
  bool quick = false;
  Verbosity verbosity;

  [[nodiscard]] BenchScope scope() const { return quick ? BenchScope::kQuick : BenchScope::kFull; }
  [[nodiscard]] bool wants(const std::string& suite) const {
    return suites.empty() || std::ranges::find(suites, suite) != suites.end();
  }
};

std::string params_text(const nlohmann::ordered_json& params) {
  std::string text;
  for (const auto& [key, value] : params.items())
    text += fmt::format("{}={} ", key, value.is_string() ? value.get<std::string>() : json_text(value));
  return text;
}

void print_text(const Machine& machine, const std::vector<BenchResult>& results) {
  fmt::print("{}, {} cores, {}, multiply-add peak {:.1f} GFLOP/s\n", machine.cpu, machine.cores,
             machine.instruction_set, machine.fma_gflops);
  for (const auto& result : results)
    fmt::print("{:<30}{:<52}{:>12.4g} {}\n", result.name, params_text(result.params), result.value,
               result.unit);
}

void print_json(const Machine& machine, const std::vector<BenchResult>& results) {
  nlohmann::ordered_json json;
  json["machine"] = {{"cpu", machine.cpu},
                     {"cores", machine.cores},
                     {"instruction_set", machine.instruction_set},
                     {"fma_gflops", machine.fma_gflops},
                     {"version", WAYMARK_VERSION},
                     {"compiler", __VERSION__}};
  json["results"] = nlohmann::ordered_json::array();
  for (const auto& result : results)
    json["results"].push_back(
        {{"name", result.name}, {"params", result.params}, {"value", result.value}, {"unit", result.unit}});
  fmt::print("{}\n", json_text(json, 2));
}

Result<void> bench(const BenchRequest& request) {
  const Machine machine = inspect_machine();
  std::vector<BenchResult> results;
  for (const Suite& suite : kSuites) {
    if (!request.wants(suite.name)) continue;
    ProgressBar bar(suite.name, request.verbosity);
    for (auto& result : suite.run(machine, request.scope(), [&bar](double fraction) { bar.show(fraction); }))
      results.push_back(std::move(result));
  }
  if (request.verbosity.json) print_json(machine, results);
  if (request.verbosity.talks()) print_text(machine, results);
  return {};
}

}  // namespace

void add_bench(CLI::App& app, Work& work) {
  auto* command = app.add_subcommand(
      "bench", "Measure the computing time of filters and camera front end on this machine");
  auto request = std::make_shared<BenchRequest>();
  std::vector<std::string> names;
  for (const Suite& suite : kSuites) names.emplace_back(suite.name);
  command->add_option("suite", request->suites, "what to measure; default everything")
      ->check(CLI::IsMember(names));
  command->add_flag("--quick", request->quick,
                    "smaller maps and fewer repetitions: a rough result within seconds");
  add_verbosity(*command, request->verbosity);
  command->footer(
      "Example:\n  waymark bench\n  waymark bench --quick\n  waymark bench ekf --json > bench.json");
  command->callback([&work, request] { work = [request] { return bench(*request); }; });
}

}  // namespace waymark::app
