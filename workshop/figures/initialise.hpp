#pragma once

#include <CLI/CLI.hpp>

namespace waymark {

/// `initialise`: depth particles of new corners, image by image, where a hand holds the camera.
void add_initialise(CLI::App& app, int& status);

}  // namespace waymark
