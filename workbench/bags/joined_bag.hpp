#pragma once

#include <memory>
#include <vector>

#include "workbench/bags/reader.hpp"

namespace waymark::bag {

/// The files of one recording, one after the other, as one bag. With `packed` every message is a zstd frame
/// of its own, as ROS 2 records with `--compression-mode message`.
[[nodiscard]] std::unique_ptr<Reader> join_bags(std::vector<std::unique_ptr<Reader>> parts, bool packed,
                                                std::vector<std::string> notes);

}  // namespace waymark::bag
