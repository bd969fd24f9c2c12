#include "workbench/run/article_methods.hpp"

#include <array>
#include <cstddef>

#include <gtest/gtest.h>

namespace waymark {
namespace {

TEST(ArticleMethods, AreSetByOneKeyAndTakenBack) {
  Config config;
  Schema schema = describe(config);
  EXPECT_FALSE(uses_article_methods(config));
  ASSERT_TRUE(schema.set("pixel.article", "true", "test").ok());
  EXPECT_TRUE(uses_article_methods(config));
  EXPECT_EQ(config.odometry.arc, ArcModel::kArticle);
  EXPECT_EQ(config.pixel.update, UpdateMethod::kTextbook);
  EXPECT_FALSE(config.tracker.finder.warp);
  ASSERT_TRUE(schema.set("pixel.article", "false", "test").ok());
  EXPECT_FALSE(uses_article_methods(config));
  const Config usual;
  EXPECT_EQ(config.odometry.arc, usual.odometry.arc);
  EXPECT_EQ(config.search.match, usual.search.match);
  EXPECT_EQ(config.tracker.finder.warp, usual.tracker.finder.warp);
  EXPECT_EQ(config.tracker.finder.subpixel, usual.tracker.finder.subpixel);
  EXPECT_EQ(config.tracker.instructions, usual.tracker.instructions);
  EXPECT_EQ(config.pixel.init, usual.pixel.init);
  EXPECT_EQ(config.pixel.depth.spacing, usual.pixel.depth.spacing);
  EXPECT_EQ(config.pixel.update, usual.pixel.update);
}

TEST(ArticleMethods, NeedEachOfTheirParts) {
  static const Config usual;
  using Undo = void (*)(Config&);
  constexpr std::array kParts{
      Undo{[](Config& c) { c.odometry.arc = usual.odometry.arc; }},
      Undo{[](Config& c) { c.search.match = usual.search.match; }},
      Undo{[](Config& c) { c.tracker.finder.warp = usual.tracker.finder.warp; }},
      Undo{[](Config& c) { c.tracker.finder.subpixel = usual.tracker.finder.subpixel; }},
      Undo{[](Config& c) { c.tracker.instructions = usual.tracker.instructions; }},
      Undo{[](Config& c) { c.pixel.init = usual.pixel.init; }},
      Undo{[](Config& c) { c.pixel.depth.spacing = usual.pixel.depth.spacing; }},
      Undo{[](Config& c) { c.pixel.update = usual.pixel.update; }}};
  for (std::size_t i = 0; i < kParts.size(); ++i) {
    Config config;
    use_article_methods(config, true);
    ASSERT_TRUE(uses_article_methods(config));
    kParts[i](config);
    EXPECT_FALSE(uses_article_methods(config)) << "part " << i;
  }
}

}  // namespace
}  // namespace waymark
