#pragma once

#include <cstdint>

#include "waymark/core/aligned_array.hpp"

#include "workbench/sim/canvas.hpp"
#include "workbench/sim/summed_mipmap_rows.hpp"

namespace waymark::sim {

/// A painted texture, ready to be looked at from any distance and slant: every level is the mean of the
/// texels that it stands for, each reduction rounded to a grey value at the end only.
class SummedMipmap {
 public:
  /// 10 ns per texel; 8 bytes per texel.
  explicit SummedMipmap(const Canvas& canvas);

  [[nodiscard]] const kernels::MipmapLayout& layout() const { return layout_; }
  [[nodiscard]] const std::uint16_t* texels() const { return texels_.data(); }

 private:
  kernels::MipmapLayout layout_;
  AlignedArray<std::uint16_t> texels_;
};

}  // namespace waymark::sim
