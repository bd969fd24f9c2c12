#pragma once

#include <filesystem>
#include <memory>
#include <string_view>

#include "workbench/bags/reader.hpp"

namespace waymark::bag {

/// Does a file that begins so call itself a database of SQLite?
[[nodiscard]] bool is_sqlite(std::string_view first_bytes);

/// Opens the .db3 file of a ROS 2 bag, of any version of its schema. Where it stores no definitions, those of
/// the standard types are taken.
[[nodiscard]] Result<std::unique_ptr<Reader>> open_sqlite_bag(const std::filesystem::path& path);

}  // namespace waymark::bag
