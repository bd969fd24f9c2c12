#include "workbench/config/known_settings.hpp"

#include <gmock/gmock.h>

namespace waymark {
namespace {

using testing::Contains;
using testing::Pair;

TEST(KnownSettings, AreThoseOfTheConfigOfThatName) {
  const auto settings = known_settings("plaza");
  ASSERT_TRUE(settings.ok()) << settings.error().message;
  EXPECT_THAT(*settings, Contains(Pair("sensor.range_scale", testing::_)));
}

TEST(KnownSettings, ThatAreNotThereAreNamed) {
  EXPECT_EQ(known_settings("nowhere").error().message, "configs/nowhere.yaml is not built into this program");
}

}  // namespace
}  // namespace waymark
