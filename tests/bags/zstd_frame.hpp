#pragma once

#include <string>
#include <string_view>

#include <zstd.h>

namespace waymark::bag::test {

/// Packs bytes as one frame.
inline std::string zstd_frame(std::string_view bytes) {
  std::string packed(ZSTD_compressBound(bytes.size()), '\0');
  packed.resize(ZSTD_compress(packed.data(), packed.size(), bytes.data(), bytes.size(), 3));
  return packed;
}

}  // namespace waymark::bag::test
