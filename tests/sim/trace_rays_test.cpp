#include "workbench/sim/trace_rays.hpp"

#include <vector>

#include "kernels/kernel_support.hpp"

namespace waymark::kernels {
namespace {

constexpr std::size_t kRays = 160;

/// A summed mipmap of random texels, whose levels are not reductions of one another.
struct RandomTexture {
  RandomTexture(MipmapLayout the_layout, RandomStream& random) : layout(the_layout), texels(layout.size()) {
    for (int lv = 0; lv < layout.levels; ++lv)
      for (int lu = 0; lu < layout.levels; ++lu) fill(lu, lv, random);
  }

  void fill(int lu, int lv, RandomStream& random) {
    std::vector<int> grey;
    for (int i = 0; i < layout.width(lu) * layout.height(lv); ++i)
      grey.push_back(static_cast<int>(random.uniform(0.0, 256.0)));
    for (int v = 0; v < layout.height(lv); ++v) {
      for (int u = 0; u <= layout.width(lu); ++u) {
        const auto at = [&](int row) {
          const int texel = row % layout.height(lv) * layout.width(lu) + u % layout.width(lu);
          return grey[static_cast<std::size_t>(texel)];
        };
        const int texel = (layout.first_row(lv) + v) * layout.pitch() + layout.first_column(lu) + u;
        texels[static_cast<std::size_t>(texel)] = static_cast<std::uint16_t>(at(v) | at(v + 1) << 8);
      }
    }
  }

  MipmapLayout layout;
  std::vector<std::uint16_t> texels;
};

float between(RandomStream& random, double low, double high) {
  return static_cast<float>(random.uniform(low, high));
}

TexturedRectangle random_rectangle(const RandomTexture& texture, std::int32_t id, RandomStream& random) {
  const auto function = [&](double size, double offset) {
    return RayFunction{between(random, -size, size), between(random, -size, size),
                       between(random, offset - size, offset + size)};
  };
  TexturedRectangle r{
      .inverse_depth = function(0.3, 0.4), .s = function(60.0, 40.0), .t = function(60.0, 0.0)};
  r.s_min = between(random, -200.0, 0.0);
  r.s_max = between(random, 0.0, 300.0);
  r.t_min = between(random, -100.0, 0.0);
  r.t_max = between(random, 0.0, 100.0);
  r.texels = texture.texels.data();
  r.layout = texture.layout;
  r.gain = between(random, 0.5, 1.0);
  r.id = id;
  return r;
}

class TraceRays : public test::OnEveryInstructionSet {
 protected:
  TraceRays() : x_(kRays), y_(kRays), grey_(kRays), id_(kRays) {
    for (std::size_t i = 0; i < kRays; ++i) {
      x_[i] = between(random_, -0.6, 0.6);
      y_[i] = between(random_, -0.5, 0.5);
    }
  }

  AlignedArray<float> x_, y_, grey_;
  AlignedArray<std::int32_t> id_;
};

WAYMARK_ON_EVERY_INSTRUCTION_SET(TraceRays);

TEST_P(TraceRays, EqualsThePlainFormulaToTheLastBit) {
  const RandomTexture wide({7, 5, 5}, random_);
  const RandomTexture high({4, 8, 4}, random_);
  AlignedArray<float> grey(kRays);
  AlignedArray<std::int32_t> id(kRays);
  int hits = 0;
  for (const float spacing : {0.0F, 0.004F, 0.05F, 1.0F}) {
    for (std::size_t n = 0; n < 20; ++n) {
      std::vector<TexturedRectangle> rectangles;
      for (std::size_t k = 0; k < n; ++k)
        rectangles.push_back(
            random_rectangle(k % 2 == 0 ? wide : high, static_cast<std::int32_t>(100 + k), random_));
      const Rays rays{x_.data(), y_.data(), spacing, 0.7F * spacing};
      trace_rays(rays, kRays, rectangles.data(), n, grey_.data(), id_.data());
      reference::trace_rays(rays, kRays, rectangles.data(), n, grey.data(), id.data());
      for (std::size_t i = 0; i < kRays; ++i) {
        ASSERT_EQ(id_[i], id[i]);
        ASSERT_EQ(grey_[i], grey[i]) << "ray " << i << " among " << n << ", spacing " << spacing;
        if (id[i] >= 0) ++hits;
      }
    }
  }
  EXPECT_GT(hits, 5000);
}

TEST_P(TraceRays, SeesTheNearerOfTwoAndNothingBeside) {
  const RandomTexture texture({4, 4, 1}, random_);
  TexturedRectangle near{.inverse_depth = {0.0F, 0.0F, 1.0F},
                         .s = {10.0F, 0.0F, 0.0F},
                         .t = {0.0F, 10.0F, 0.0F},
                         .s_min = -1.0F,
                         .s_max = 1.0F,
                         .t_min = -100.0F,
                         .t_max = 100.0F,
                         .texels = texture.texels.data(),
                         .layout = texture.layout,
                         .gain = 1.0F,
                         .id = 7};
  TexturedRectangle far = near;
  far.inverse_depth.z = 0.5F;
  far.s_min = -4.0F;
  far.s_max = 4.0F;
  far.id = 9;
  const std::vector rectangles{far, near};
  trace_rays({x_.data(), y_.data(), 0.0F, 0.0F}, kRays, rectangles.data(), 2, grey_.data(), id_.data());
  for (std::size_t i = 0; i < kRays; ++i) {
    const float distance = std::abs(x_[i]);
    ASSERT_EQ(id_[i], distance <= 0.1F ? 7 : distance <= 0.2F ? 9 : -1);
    ASSERT_TRUE(id_[i] >= 0 || grey_[i] == 0.0F);
  }
}

}  // namespace
}  // namespace waymark::kernels
