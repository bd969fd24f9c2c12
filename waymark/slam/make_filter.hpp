#pragma once

#include <memory>

#include "waymark/core/filter.hpp"
#include "waymark/slam/config.hpp"

namespace waymark {

/// The filter that the config asks for, at the origin and sure of it.
[[nodiscard]] Result<std::unique_ptr<Filter>> make_filter(const Config& config);

[[nodiscard]] const char* filter_name(FilterKind kind);

}  // namespace waymark
