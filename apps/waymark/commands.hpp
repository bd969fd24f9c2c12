#pragma once

#include <functional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "waymark/core/result.hpp"

#include "console.hpp"
#include "workbench/run/config.hpp"

namespace waymark::app {

/// What a command line asks for, to be done after all of it was understood.
using Work = std::function<Result<void>()>;

/// Each adds its subcommand to `app`; parsing it sets `work`.
void add_run(CLI::App& app, Work& work);
void add_live(CLI::App& app, Work& work);
void add_demo(CLI::App& app, Work& work);
void add_sim(CLI::App& app, Work& work);
void add_eval(CLI::App& app, Work& work);
void add_check(CLI::App& app, Work& work);
void add_calibrate(CLI::App& app, Work& work);
void add_bench(CLI::App& app, Work& work);
void add_sweep(CLI::App& app, Work& work);
void add_tune(CLI::App& app, Work& work);
void add_map(CLI::App& app, Work& work);
void add_config(CLI::App& app, Work& work);

/// --config, --set, --seed and --threads, with the same meaning wherever they appear.
struct SettingsFlags {
  std::vector<std::string> files;
  std::vector<std::string> assignments;
  std::string seed;
  std::string threads;
  std::vector<std::string> more_inputs;

  void add_to(CLI::App& command);
  /// Takes the words behind `input` as further bags of its drive. Throws CLI::ExtrasError where `input` is no
  /// file or folder, or a word is an option.
  void take_more_inputs(const CLI::App& command, const std::string& input);
  [[nodiscard]] UserSettings settings() const;
};

void add_verbosity(CLI::App& command, Verbosity& verbosity);

/// The shell command that was given, for the report.
void remember_command_line(int argc, char** argv);
[[nodiscard]] const std::string& command_line();

}  // namespace waymark::app
