#pragma once

#include <CLI/CLI.hpp>

namespace waymark {

/// Adds `desk`: corners and patches in images of a camera that is carried by hand, without any filter: how
/// many, for how long they are followed, whether their motion agrees, and what it takes. `status` becomes
/// what the program is to end with.
void add_desk(CLI::App& app, int& status);

}  // namespace waymark
