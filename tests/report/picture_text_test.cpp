#include "workbench/report/picture_text.hpp"

#include <gtest/gtest.h>

namespace waymark {
namespace {

TEST(PictureText, IsAPngFileThatForgetsTheLastBits) {
  const std::string text = picture_text(GreyImage(8, 8, 100));
  EXPECT_TRUE(text.starts_with("iVBORw0KGgo")) << text;  // the first bytes of every PNG file
  EXPECT_EQ(text, picture_text(GreyImage(8, 8, 103)));
  EXPECT_NE(text, picture_text(GreyImage(8, 8, 104)));
}

}  // namespace
}  // namespace waymark
