#include <algorithm>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <string>
#include <system_error>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "waymark/core/failure.hpp"
#include "waymark/kernels/instruction_set.hpp"

#include "commands.hpp"
#include "usage_error.hpp"

namespace waymark::app {
namespace {

std::string remembered_command_line;

constexpr const char* kFooter =
    "Example, no data needed:\n"
    "  waymark demo                                   simulate a drive, run both filters, write a report\n"
    "Example, a recording:\n"
    "  waymark check LOG                              list its contents and the command to run on it\n"
    "  waymark run LOG -o out && xdg-open out/report.html\n\n"
    "Exit status: 0 success, 1 failure while running, 2 wrong usage or bad input.";

int report(const Error& error) {
  print_error("waymark: " + error.message + "\n");
  return error.kind == Error::Kind::kBadInput ? 2 : 1;
}

/// The instruction set that WAYMARK_INSTRUCTION_SET asks for, instead of the best of this processor.
Result<void> choose_instruction_set() {
  const char* name = std::getenv("WAYMARK_INSTRUCTION_SET");
  if (name == nullptr || kernels::use_instruction_set(name)) return {};
  return Error{fmt::format(
      "WAYMARK_INSTRUCTION_SET: '{}' is unknown or not supported by this processor, which supports {}", name,
      fmt::join(kernels::instruction_sets(), ", "))};
}

}  // namespace

void SettingsFlags::add_to(CLI::App& command) {
  command
      .add_option(
          "--config", files,
          "YAML file with config keys (see `waymark config`); may be given several times, later files win")
      ->type_name("FILE")
      ->allow_extra_args(false);
  command
      .add_option(
          "--set", assignments,
          "value of one config key, for example --set sensor.range_sigma_m=0.1; wins over files and other "
          "flags")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
  command.add_option("--seed", seed, "seed of all random numbers (config key seed)")->type_name("N");
  command
      .add_option("--threads", threads, "number of threads; does not change the result (config key threads)")
      ->type_name("N");
}

void SettingsFlags::take_more_inputs(const CLI::App& command, const std::string& input) {
  more_inputs = command.remaining();
  const bool is_option =
      std::ranges::any_of(more_inputs, [](const std::string& word) { return word.starts_with('-'); });
  std::error_code ignored;
  if (is_option || (!more_inputs.empty() && !std::filesystem::exists(input, ignored)))
    throw CLI::ExtrasError(command.get_name(), more_inputs);
}

UserSettings SettingsFlags::settings() const {
  UserSettings user;
  user.files.assign(files.begin(), files.end());
  user.assignments = assignments;
  if (!seed.empty()) user.flags.push_back({"--seed", "seed", seed});
  if (!threads.empty()) user.flags.push_back({"--threads", "threads", threads});
  if (!more_inputs.empty())
    user.flags.push_back({"LOG", "input.more_bags", fmt::format("{}", fmt::join(more_inputs, ","))});
  return user;
}

void add_verbosity(CLI::App& command, Verbosity& verbosity) {
  command.add_flag("--quiet", verbosity.quiet, "print errors only");
  command.add_flag("--json", verbosity.json,
                   "print the result as JSON, and nothing else, on standard output");
}

void remember_command_line(int argc, char** argv) {
  remembered_command_line = "waymark";
  for (int i = 1; i < argc; ++i) remembered_command_line += std::string(" ") + argv[i];
}

const std::string& command_line() { return remembered_command_line; }

int run_program(int argc, char** argv) {
  if (const auto chosen = choose_instruction_set(); !chosen) return report(chosen.error());
  CLI::App app{"Waymark: real-time landmark SLAM for wheeled robots", "waymark"};
  app.set_version_flag("--version", "waymark " WAYMARK_VERSION);
  app.require_subcommand(1);
  app.footer(kFooter);
  Work work;
  add_run(app, work);
  add_live(app, work);
  add_demo(app, work);
  add_sim(app, work);
  add_eval(app, work);
  add_sweep(app, work);
  add_tune(app, work);
  add_check(app, work);
  add_calibrate(app, work);
  add_bench(app, work);
  add_map(app, work);
  add_config(app, work);
  remember_command_line(argc, argv);
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& asked) {
    return app.exit(asked);
  } catch (const CLI::ParseError& wrong) {
    return report(usage_error(app, wrong));
  }
  const auto done = work();
  return done ? 0 : report(done.error());
}

/// That standard output does not take what is printed is thrown, or shows only when all is done.
int run_and_report(int argc, char** argv) {
  int status = 0;
  std::string lost;
  try {
    status = run_program(argc, argv);
    lost = output_failure();
  } catch (const std::exception& problem) {
    lost = output_failure();
    if (lost.empty()) return report(failure(problem));
  }
  return status == 0 && !lost.empty() ? report({lost, Error::Kind::kFailed}) : status;
}

}  // namespace waymark::app

int main(int argc, char** argv) {
  waymark::app::reserve_standard_streams();
  try {
    return waymark::app::run_and_report(argc, argv);
  } catch (const std::exception&) {  // no memory for the words, even
    waymark::app::print_error("waymark: out of memory\n");
    return 1;
  }
}
