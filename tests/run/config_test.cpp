#include "workbench/run/config.hpp"

#include <algorithm>
#include <filesystem>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include "support/io_support.hpp"

#include "workbench/config/former_keys.hpp"
#include "workbench/config/read_file.hpp"

namespace waymark {
namespace {

TEST(Config, TheConfigInForceReadsBackAsItself) {
  Config config;
  Schema schema = describe(config);
  ASSERT_TRUE(schema.set_assignment("sensor.bearing_sigma_deg=0.1234567890123", "test").ok());
  ASSERT_TRUE(schema.set_assignment("ekf.consistency=fej", "test").ok());
  const std::string yaml = schema.to_yaml();
  Config again;
  Schema schema_again = describe(again);
  ASSERT_TRUE(schema_again.load_text(yaml, "yaml").ok());
  EXPECT_EQ(again.sensor.bearing_sigma_deg, 0.1234567890123);
  EXPECT_EQ(again.ekf.consistency, ekf::Consistency::kFej);
  const auto values = [](const Schema& s) {
    std::string all;
    for (const auto& key : s.keys()) all += key + "=" + s.value(key) + "\n";
    return all;
  };
  EXPECT_EQ(values(schema_again), values(schema));
}

TEST(Config, EveryKeyHasAUniqueName) {
  Config config;
  auto keys = describe(config).keys();
  std::ranges::sort(keys);
  EXPECT_EQ(std::ranges::adjacent_find(keys), keys.end());
}

TEST(Config, FormerKeysAreNoneAndWhatReplacedThemIsOne) {
  Config config;
  const Schema schema = describe(config);
  for (const FormerKey& each : former_keys()) {
    EXPECT_FALSE(schema.has(each.key)) << each.key;
    EXPECT_TRUE(each.now.empty() || schema.has(each.now)) << each.now;
  }
}

/// The pages of docs/ one after another, but for those of these names.
std::string pages_but(const std::set<std::string>& names) {
  std::string pages;
  for (const auto& entry : std::filesystem::directory_iterator(WAYMARK_CONFIG_DIR "/../docs"))
    if (entry.path().extension() == ".md" && !names.contains(entry.path().stem()))
      pages += read_file(entry.path()).value();
  return pages;
}

TEST(Config, ShowsOnlyKeysThatAPageNames) {
  const std::string pages = pages_but({});
  Config config;
  const Schema schema = describe(config);
  for (const auto& key : schema.keys()) {
    if (!schema.is_shown(key)) continue;
    EXPECT_NE(pages.find(key), std::string::npos) << key;
  }
}

TEST(Config, ShowsTheKeysThatAPageTellsAUserToSet) {
  // The settings in these pages are those of measurements. Simulated worlds have `waymark config sim`.
  const std::string pages = pages_but({"association", "camera", "ekf", "fastslam", "results"});
  Config config;
  const Schema schema = describe(config);
  for (const auto& key : schema.keys()) {
    if (key.starts_with("sim.") || pages.find(key + "=") == std::string::npos) continue;
    EXPECT_TRUE(schema.is_shown(key)) << key;
  }
}

TEST(Config, LaterSettingsWin) {
  const test::TempFolder folder;
  const auto file = folder.write("first.yaml", "seed: 5\nthreads: 2\n");
  const auto later = folder.write("later.yaml", "threads: 3\n");
  const auto config = resolve_config({{file, later}, {"seed=6"}});
  const auto alone = resolve_config({{file}, {}});
  ASSERT_TRUE(config.ok() && alone.ok());
  EXPECT_EQ(config->seed, 6U);
  EXPECT_EQ(config->threads, 3);
  EXPECT_EQ(alone->threads, 2);
}

TEST(Config, SingleKeysWinOverFlagsAndFlagsOverFiles) {
  const test::TempFolder folder;
  const auto file = folder.write("user.yaml", "seed: 5\nthreads: 2\n");
  UserSettings user{{file}, {"seed=6"}};
  user.flags = {{"--seed", "seed", "7"}, {"--threads", "threads", "3"}};
  const auto config = resolve_config(user);
  ASSERT_TRUE(config.ok());
  EXPECT_EQ(config->seed, 6U);
  EXPECT_EQ(config->threads, 3);
}

TEST(Config, ATemplateLeavesToTheLogWhatTheLogStates) {
  const test::TempFolder folder;
  Config defaults;
  const std::string yaml = describe(defaults).to_template([](const std::string&) { return true; });
  const auto plain = open_input("sim:study", {});
  const auto with_template = open_input("sim:study", {{folder.write("my.yaml", yaml)}, {}});
  ASSERT_TRUE(plain.ok() && with_template.ok());
  EXPECT_EQ(with_template->config.odometry.wheels.left_radius_m, plain->config.odometry.wheels.left_radius_m);
  EXPECT_EQ(with_template->config.sensor.bearing_sigma_deg, plain->config.sensor.bearing_sigma_deg);
}

TEST(Config, AMistypedKeyNamesTheNearest) {
  const auto config = resolve_config({{}, {"ekf.consistancy=fej"}});
  ASSERT_FALSE(config.ok());
  EXPECT_NE(config.error().message.find("ekf.consistency"), std::string::npos) << config.error().message;
  EXPECT_EQ(config.error().kind, Error::Kind::kBadInput);
}

TEST(Config, TheUserOutranksTheLogAndTheLogTheDefaults) {
  const auto plain = open_input("sim:study", {});
  ASSERT_TRUE(plain.ok());
  EXPECT_EQ(plain->config.sensor.bearing_sigma_deg, 1.5);  // the study's sensor
  const auto changed = open_input("sim:study", {{}, {"sensor.bearing_sigma_deg=3"}});
  ASSERT_TRUE(changed.ok());
  EXPECT_EQ(changed->config.sensor.bearing_sigma_deg, 3.0);
}

TEST(Config, ALogWithoutIdentitiesAsksForAssociationUnlessTheUserSaysOtherwise) {
  const auto associate = [](const std::vector<std::string>& assignments) {
    const auto opened = open_input("sim:forest", {{}, assignments});
    return opened.ok() ? std::optional(opened->config.associate) : std::nullopt;
  };
  EXPECT_EQ(associate({}), Association::kJcbb);
  EXPECT_EQ(associate({"filter=fastslam"}), Association::kMl);
  EXPECT_EQ(associate({"associate=nearest"}), Association::kNearest);
  EXPECT_EQ(associate({"sim.identities=true"}), Association::kKnown);
  EXPECT_EQ(associate({"associate=known"}), Association::kKnown);
}

TEST(Config, ALogOfImagesIsObservedByPixelsUnlessTheUserSaysOtherwise) {
  const auto observe = [](const std::string& input, const std::vector<std::string>& assignments) {
    const auto opened = open_input(input, {{}, assignments});
    return opened.ok() ? std::optional(opened->config.observe) : std::nullopt;
  };
  EXPECT_EQ(observe("sim:room", {}), Observe::kPixel);
  EXPECT_EQ(observe("sim:room", {"observe=bearing"}), Observe::kBearing);
  EXPECT_EQ(observe("sim:square", {}), Observe::kRangeBearing);
}

TEST(Config, AnUnknownScenarioNamesTheNearest) {
  const auto opened = open_input("sim:sqare", {});
  ASSERT_FALSE(opened.ok());
  EXPECT_NE(opened.error().message.find("square"), std::string::npos) << opened.error().message;
}

TEST(Config, EveryShippedConfigIsValid) {
  int files = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(WAYMARK_CONFIG_DIR)) {
    if (!entry.is_regular_file()) continue;
    const auto config = resolve_config({{entry.path()}, {}});
    EXPECT_TRUE(config.ok()) << config.error().message;
    ++files;
  }
  EXPECT_GT(files, 0);
}

}  // namespace
}  // namespace waymark
