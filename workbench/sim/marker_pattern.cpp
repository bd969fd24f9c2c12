#include "workbench/sim/marker_pattern.hpp"

#include <array>
#include <cstdint>

namespace waymark::sim {
namespace {

constexpr float kInk = 20.0F;
constexpr float kPaper = 225.0F;

// The bits of each marker, row after row, the upper left one first.
constexpr std::array<std::uint16_t, kMarkerPatterns> kCodes{
    0xB532, 0x0F9A, 0x332D, 0x9946, 0x549E, 0x79CD, 0x9E2E, 0xC4F2, 0xFEDA, 0xCF56, 0xF991, 0x11A7, 0x0EB7,
    0x2A0F, 0x24B1, 0x263E, 0x4665, 0x6600, 0x6C5E, 0x76AF, 0x868B, 0xB02B, 0xCCD5, 0xDD82, 0xFE47, 0x9471,
    0xACE4, 0xA554, 0x2123, 0x346F, 0x4415, 0x57B2, 0x9ECF, 0xF0CB, 0x08AE, 0x0929, 0x1875, 0x04FF, 0x0DF6,
    0x1C5A, 0x1718, 0x2A28, 0x328C, 0x38B2, 0x24E8, 0x2EEB, 0x2D3F, 0x4B64, 0x502E, 0x5013};

constexpr int kBits = 4;

}  // namespace

bool is_white(int number, int column, int row) {
  const int last = kMarkerCells - 1;
  if (column == 0 || row == 0 || column == last || row == last) return true;
  const int u = column - 2, v = row - 2;
  if (u < 0 || v < 0 || u >= kBits || v >= kBits) return false;
  return (kCodes[static_cast<std::size_t>(number)] >> (kBits * kBits - 1 - kBits * v - u) & 1) != 0;
}

Canvas paint_marker(int number) {
  constexpr int kLog2Side = 8;
  static_assert(kMarkerCells * kTexelsPerMarkerCell == 1 << kLog2Side);
  Canvas canvas(kLog2Side, kLog2Side, kInk);
  for (int row = 0; row < kMarkerCells; ++row)
    for (int column = 0; column < kMarkerCells; ++column)
      if (is_white(number, column, row))
        canvas.fill({column * kTexelsPerMarkerCell, row * kTexelsPerMarkerCell, kTexelsPerMarkerCell,
                     kTexelsPerMarkerCell},
                    kPaper);
  return canvas;
}

}  // namespace waymark::sim
