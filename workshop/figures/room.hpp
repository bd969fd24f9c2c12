#pragma once

#include <CLI/CLI.hpp>

namespace waymark {

/// Adds `room`: the whole camera system over many drives through a rendered room.
void add_room(CLI::App& app, int& status);

}  // namespace waymark
