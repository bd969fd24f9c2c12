#include "workbench/report/article_times.hpp"

#include <array>

#include <gtest/gtest.h>

namespace waymark {
namespace {

TEST(ArticleTimes, BlocksMakeUpTheFrame) {
  double sum_us = 0.0;
  for (const auto* name :
       {"FB1 predict", "FB2 corners", "FB3", "FB4 match", "FB5", "FB6 estimate", "FB7", "FB8", "FB9 add"}) {
    const auto time = article_time(name);
    ASSERT_TRUE(time.has_value()) << name;
    EXPECT_NEAR(time->per_call_us * time->calls_per_frame, time->per_frame_us, 0.08 * time->per_frame_us);
    sum_us += time->per_frame_us;
  }
  EXPECT_NEAR(sum_us, kArticleFrame_us, 0.002 * kArticleFrame_us);
}

TEST(ArticleTimes, OtherBlocksHaveNone) {
  EXPECT_FALSE(article_time("predict").has_value());
  EXPECT_FALSE(article_time("FB10 more").has_value());
  EXPECT_FALSE(article_time("").has_value());
}

TEST(ArticleTimes, AreThoseOfItsOwnSystemOnly) {
  const auto article = resolve_config({{WAYMARK_SOURCE_DIR "/configs/vincke2012.yaml"}, {}});
  ASSERT_TRUE(article.ok()) << article.error().message;
  EXPECT_TRUE(is_article_system(*article));
  EXPECT_FALSE(is_article_system(Config{}));
  const auto ours = resolve_config({{}, {"observe=pixel"}});
  ASSERT_TRUE(ours.ok());
  EXPECT_FALSE(is_article_system(*ours));
}

}  // namespace
}  // namespace waymark
