// The kernels of the camera front end, each on every instruction set of this machine; items are candidates
// (ZMSSD) or frames (corners).
#include <string>
#include <vector>

#include <benchmark/benchmark.h>
#include <hwy/targets.h>

#include "waymark/core/grey_image.hpp"
#include "waymark/core/random.hpp"
#include "waymark/kernels/zmssd.hpp"

namespace waymark::kernels {
namespace {

// Smooth texture of all scales, as walls and posters have it.
GreyImage texture(int width_px, int height_px) {
  RandomStream random(1, StreamPurpose::kWorld);
  GreyImage image(width_px, height_px);
  for (int v = 0; v < height_px; ++v)
    for (int u = 0; u < width_px; ++u) image(u, v) = static_cast<std::uint8_t>(random.uniform(0.0, 256.0));
  return image;
}

const GreyImage& frame() {
  static const GreyImage image = texture(320, 240);
  return image;
}

// Rows of `count` windows, as a search sees them.
void search_rows(benchmark::State& state, std::int64_t target, int size, int count) {
  hwy::SetSupportedTargetsForTest(target);
  const ZmssdPatch patch = make_zmssd_patch(frame().view().pixel(100, 100), frame().stride(), size);
  std::vector<std::uint32_t> scores(static_cast<std::size_t>(count));
  int v = 0;
  for (auto _ : state) {
    v = (v + 1) % 200;
    zmssd_row(patch, frame().view().pixel(50, v), frame().stride(), scores.size(), scores.data());
    benchmark::DoNotOptimize(scores.data());
    benchmark::ClobberMemory();
  }
  state.SetItemsProcessed(state.iterations() * count);
  hwy::SetSupportedTargetsForTest(0);
}

void search_rows_plain(benchmark::State& state, int size, int count) {
  const std::uint8_t* patch = frame().view().pixel(100, 100);
  int v = 0;
  for (auto _ : state) {
    v = (v + 1) % 200;
    for (int u = 0; u < count; ++u) {
      benchmark::DoNotOptimize(
          reference::zmssd(patch, frame().stride(), frame().view().pixel(50 + u, v), frame().stride(), size));
    }
  }
  state.SetItemsProcessed(state.iterations() * count);
}

const bool kRegistered = [] {
  for (const int size : {16, 13, 11, 9, 8}) {
    for (const int count : {8, 24, 64, 200}) {
      const std::string suffix = "/" + std::to_string(size) + "/" + std::to_string(count);
      for (const std::int64_t target : hwy::SupportedAndGeneratedTargets())
        benchmark::RegisterBenchmark(("zmssd_row/" + std::string(hwy::TargetName(target)) + suffix).c_str(),
                                     search_rows, target, size, count);
      benchmark::RegisterBenchmark(("zmssd_row/plain" + suffix).c_str(), search_rows_plain, size, count);
    }
  }
  return true;
}();

}  // namespace
}  // namespace waymark::kernels
