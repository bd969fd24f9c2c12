#pragma once

#include <filesystem>
#include <memory>
#include <string_view>

#include "workbench/bags/reader.hpp"

namespace waymark::bag {

/// Does a file that begins so call itself an MCAP file, of whatever version?
[[nodiscard]] bool is_mcap(std::string_view first_bytes);

/// Opens an MCAP file (mcap.dev/spec), with chunks in lz4, zstd or neither, or without chunks. One without a
/// summary, because recording ended early, or that is cut off is read as far as it goes.
[[nodiscard]] Result<std::unique_ptr<Reader>> open_mcap(const std::filesystem::path& path);

}  // namespace waymark::bag
