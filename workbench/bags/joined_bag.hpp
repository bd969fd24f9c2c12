#pragma once

#include <memory>
#include <vector>

#include "workbench/bags/reader.hpp"

namespace waymark::bag {

/// The files of one recording, one after the other, as one bag. A message that is a zstd frame, as ROS 2
/// records with `--compression-mode message`, is unpacked: CDR begins otherwise.
[[nodiscard]] std::unique_ptr<Reader> join_bags(std::vector<std::unique_ptr<Reader>> parts,
                                                std::vector<std::string> notes);

}  // namespace waymark::bag
