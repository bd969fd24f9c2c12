#pragma once

#include "workbench/run/config.hpp"

namespace waymark {

/// Whether a config makes of pixels what Vincke, Elouardi and Lambert (2012) do: arcs of k = 1, whole pixels
/// found by the weighted ZMSSD of patches that are never warped, depth particles that are even over depth,
/// points, dense matrices, scalar code.
[[nodiscard]] bool uses_article_methods(const Config& config);

/// Sets what that depends on, or sets it to its defaults.
void use_article_methods(Config& config, bool use);

}  // namespace waymark
