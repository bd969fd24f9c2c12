#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string_view>

#include "workbench/bags/byte_stream.hpp"

namespace waymark::bag {

/// What `packed` holds by the name that bags give a compression: "bz2", "lz4" (a frame), "zstd"; "none" and
/// "" hand it through. Null for a name that is not known. Bounded in memory whatever the input says: 128 MB
/// for a zstd frame of the widest window, below 10 MB for all that recorders write.
[[nodiscard]] std::unique_ptr<ByteStream> decompressed(std::string_view compression,
                                                       std::unique_ptr<ByteStream> packed);

/// Hands a stream through and ends in an error where it does not keep what was promised: its size, and its
/// CRC-32 where there is one. Never gives more than the promised size.
[[nodiscard]] std::unique_ptr<ByteStream> checked(std::unique_ptr<ByteStream> stream, std::uint64_t size,
                                                  std::optional<std::uint32_t> crc32);

}  // namespace waymark::bag
