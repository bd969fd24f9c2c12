#pragma once

#include <string>

#include <CLI/CLI.hpp>

#include "workbench/run/config.hpp"

namespace waymark::app {

/// Which filter runs, on what: flags of all commands that run one.
struct FilterFlags {
  std::string filter;
  std::string observe;
  std::string associate;
  std::string particles;
  std::string map;
  bool localize = false;

  void add_to(CLI::App& command);
  void add_to(UserSettings& user) const;
};

}  // namespace waymark::app
