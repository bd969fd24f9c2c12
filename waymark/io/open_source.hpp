#pragma once

#include <filesystem>
#include <memory>

#include "waymark/core/config.hpp"
#include "waymark/core/result.hpp"
#include "waymark/core/source.hpp"
#include "waymark/io/mrclam.hpp"

namespace waymark {

/// What a user may have to say about an input; its format is not among it.
struct InputOptions {
  MrclamOptions mrclam;
};

/// Keys input.*.
void describe(Schema& schema, InputOptions& options);

/// Opens a recording of any known format, recognised by what it holds: a Waymark log folder or an MRCLAM
/// dataset.
[[nodiscard]] Result<std::unique_ptr<Source>> open_source(const std::filesystem::path& path,
                                                          const InputOptions& options = {});

}  // namespace waymark
