#pragma once

#include <CLI/CLI.hpp>

namespace waymark {

/// Adds `markers`: the whole marker system over many drives through rendered rooms.
void add_markers(CLI::App& app, int& status);

}  // namespace waymark
