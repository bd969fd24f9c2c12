#include "workbench/config/module.hpp"

#include <cstdlib>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace waymark {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

const fs::path kFixtures = WAYMARK_MODULE_FIXTURES;

TEST(Module, GivesItsFunctions) {
  const auto functions = load_module("fixture", {kFixtures / "nowhere", kFixtures});
  ASSERT_TRUE(functions) << functions.error().message;
  EXPECT_EQ(*static_cast<const int*>(*functions), 42);
}

TEST(Module, ThatIsMissingIsNamed) {
  const auto functions = load_module("nothing", {kFixtures});
  ASSERT_FALSE(functions);
  EXPECT_EQ(functions.error().message, "waymark-nothing.so is not installed");
}

TEST(Module, OfAnotherVersionIsRefused) {
  const auto functions = load_module("old-fixture", {kFixtures});
  ASSERT_FALSE(functions);
  EXPECT_THAT(functions.error().message, HasSubstr("waymark-old-fixture.so is from Waymark 0.0.0, compiler"));
  EXPECT_THAT(functions.error().message, HasSubstr("build both together"));
}

TEST(Module, ThatIsNoLibraryIsRefusedInOneLine) {
  const fs::path file = fs::path(testing::TempDir()) / "waymark-text.so";
  std::ofstream(file) << "no library\n";
  const auto functions = load_module("text", {testing::TempDir()});
  ASSERT_FALSE(functions);
  EXPECT_THAT(functions.error().message, HasSubstr("cannot be loaded: "));
  EXPECT_EQ(functions.error().message.find('\n'), std::string::npos);
  fs::remove(file);
}

TEST(ModuleFolders, AreBesideTheProgramAndWhereItIsInstalled) {
  ASSERT_EQ(unsetenv("WAYMARK_MODULE_DIR"), 0);
  const auto folders = module_folders();
  ASSERT_EQ(folders.size(), 3U);
  EXPECT_EQ(folders[0], fs::read_symlink("/proc/self/exe").parent_path());
  EXPECT_EQ(folders[1].parent_path().parent_path().parent_path(), folders[0].parent_path().parent_path());
  for (const auto& installed : {folders[1], folders[2]}) EXPECT_EQ(installed.filename(), "waymark");
}

TEST(ModuleFolders, AreTheOneThatTheEnvironmentNames) {
  ASSERT_EQ(setenv("WAYMARK_MODULE_DIR", "/some/where", 1), 0);
  EXPECT_EQ(module_folders(), std::vector<fs::path>{"/some/where"});
  ASSERT_EQ(unsetenv("WAYMARK_MODULE_DIR"), 0);
}

}  // namespace
}  // namespace waymark
