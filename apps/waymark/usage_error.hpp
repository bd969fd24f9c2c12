#pragma once

#include <CLI/CLI.hpp>

#include "waymark/core/result.hpp"

namespace waymark::app {

/// One line for a command line that `app` could not understand: what is mistyped or missing, what was likely
/// meant, and which help to see.
[[nodiscard]] Error usage_error(const CLI::App& app, const CLI::ParseError& wrong);

}  // namespace waymark::app
