// Prints checksums of what the integer kernels make of fixed inputs, one line per instruction set: they must
// be the same on all, and on other processors. scripts/check_arm.sh compares.
#include <cstdint>
#include <cstdio>
#include <vector>

#include "waymark/kernels/fast_corners.hpp"
#include "waymark/kernels/highway_targets.hpp"
#include "waymark/kernels/zmssd.hpp"

namespace waymark::kernels {
namespace {

constexpr int kWidth = 200, kHeight = 120;

// Squares and noise from a linear congruential generator (Knuth's MMIX), which is the same everywhere.
std::vector<std::uint8_t> frame() {
  std::uint64_t state = 1;
  const auto draw = [&state](std::uint64_t below) {
    state = state * 6364136223846793005U + 1442695040888963407U;
    return static_cast<int>((state >> 33U) % below);
  };
  std::vector<std::uint8_t> pixels(kWidth * kHeight);
  for (int i = 0; i < 600; ++i) {
    const int u = draw(kWidth - 20), v = draw(kHeight - 20), side = 2 + draw(18), grey = draw(250);
    for (int row = v; row < v + side; ++row)
      for (int column = u; column < u + side; ++column)
        *(pixels.data() + row * kWidth + column) = static_cast<std::uint8_t>(grey + draw(6));
  }
  return pixels;
}

// FNV-1a.
class Checksum {
 public:
  void add(std::uint32_t value) {
    for (int byte = 0; byte < 4; ++byte) sum_ = (sum_ ^ ((value >> (8 * byte)) & 255U)) * 1099511628211U;
  }
  [[nodiscard]] unsigned long long value() const { return sum_; }

 private:
  std::uint64_t sum_ = 14695981039346656037U;
};

unsigned long long searches(const std::vector<std::uint8_t>& image) {
  Checksum sum;
  for (const int size : {8, 9, 11, 13, 16}) {
    const ZmssdPatch patch = make_zmssd_patch(image.data() + 40 * kWidth + 60, kWidth, size);
    std::vector<WindowRow> rows;
    for (int k = 0; k < 100; ++k) rows.push_back({k / 2, k * 37 % (kWidth - size - k / 2)});
    std::size_t count = 0;
    for (const WindowRow& row : rows) count += static_cast<std::size_t>(row.count);
    std::vector<std::uint32_t> scores(count);
    zmssd_search(patch, image.data(), kWidth, rows.data(), rows.size(), scores.data());
    for (const std::uint32_t score : scores) sum.add(score);
  }
  return sum.value();
}

unsigned long long corners(const std::vector<std::uint8_t>& image) {
  Checksum sum;
  constexpr int kCount = kWidth - 2 * kFastRadius;
  std::vector<std::uint8_t> scores(static_cast<std::size_t>(kWidth) * kHeight);
  std::vector<std::int32_t> places(kCount);
  for (int arc = kMinFastArc; arc <= kMaxFastArc; ++arc) {
    for (int v = kFastRadius; v < kHeight - kFastRadius; ++v) {
      const std::ptrdiff_t at = v * kWidth + kFastRadius;
      sum.add(fast_scores(image.data() + at, kWidth, kCount, 15, arc, scores.data() + at) ? 1 : 0);
    }
    for (const std::uint8_t score : scores) sum.add(score);
    for (int v = kFastRadius; v < kHeight - kFastRadius; ++v) {
      const std::uint8_t* row = scores.data() + v * kWidth + kFastRadius;
      const std::size_t found = largest_scores(row - kWidth, row, row + kWidth, kCount, places.data());
      for (std::size_t i = 0; i < found; ++i) sum.add(static_cast<std::uint32_t>(places[i]));
    }
  }
  return sum.value();
}

void print_line(const char* instruction_set) {
  const std::vector<std::uint8_t> image = frame();
  std::printf("zmssd %016llx corners %016llx on %s\n", searches(image), corners(image), instruction_set);
}

}  // namespace
}  // namespace waymark::kernels

int main() {
#ifdef HWY_COMPILE_ONLY_STATIC
  waymark::kernels::print_line(hwy::TargetName(HWY_STATIC_TARGET));
#else
  for (const std::int64_t set : hwy::SupportedAndGeneratedTargets()) {
    hwy::SetSupportedTargetsForTest(set);
    waymark::kernels::print_line(hwy::TargetName(set));
  }
#endif
}
