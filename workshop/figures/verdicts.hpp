#pragma once

#include <CLI/CLI.hpp>

namespace waymark {

/// Adds `verdicts`: simulated runs with one fault each and their twins without, and how often the verdict
/// calls good what is wrong and what is not.
void add_verdicts(CLI::App& app);

}  // namespace waymark
