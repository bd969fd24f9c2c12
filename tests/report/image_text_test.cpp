#include "workbench/report/image_text.hpp"

#include <gtest/gtest.h>

namespace waymark {
namespace {

TEST(ImageText, IsAPngFileThatForgetsTheLastBits) {
  const std::string text = image_text(GreyImage(8, 8, 100));
  EXPECT_TRUE(text.starts_with("iVBORw0KGgo")) << text;  // the first bytes of every PNG file
  EXPECT_EQ(text, image_text(GreyImage(8, 8, 103)));
  EXPECT_NE(text, image_text(GreyImage(8, 8, 104)));
}

}  // namespace
}  // namespace waymark
