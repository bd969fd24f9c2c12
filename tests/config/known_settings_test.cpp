#include "workbench/config/known_settings.hpp"

#include <algorithm>

#include <gmock/gmock.h>

#include "workbench/config/known_settings_text.hpp"
#include "workbench/run/config.hpp"

namespace waymark {
namespace {

using testing::Contains;
using testing::Pair;

TEST(KnownSettings, AreThoseOfTheConfigOfThatName) {
  const auto settings = known_settings("plaza");
  ASSERT_TRUE(settings.ok()) << settings.error().message;
  EXPECT_THAT(*settings, Contains(Pair("sensor.range_scale", testing::_)));
}

TEST(KnownSettings, OfEveryConfigAreKeysThatThereAre) {
  ASSERT_FALSE(known_settings_texts().empty());
  for (const SettingsText& text : known_settings_texts()) {
    const auto settings = known_settings(text.name);
    ASSERT_TRUE(settings.ok()) << settings.error().message;
    Config config;
    Schema schema = describe(config);
    for (const auto& [key, value] : *settings) {
      const auto set = schema.set(key, value, "test");
      EXPECT_TRUE(set.ok()) << text.name << ": " << set.error().message;
    }
  }
}

TEST(KnownSettings, ThatAreNotThereAreNamed) {
  EXPECT_EQ(known_settings("nowhere").error().message, "configs/nowhere.yaml is not built into this program");
}

}  // namespace
}  // namespace waymark
