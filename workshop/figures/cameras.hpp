#pragma once

#include <CLI/CLI.hpp>

namespace waymark {

/// Adds `cameras`: how often photographs of one camera are taken for those of two, and those of two found.
void add_cameras(CLI::App& app);

}  // namespace waymark
