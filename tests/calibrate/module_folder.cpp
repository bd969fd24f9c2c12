// OpenCV's module lies beside the programs, not beside the tests.

#include <cstdlib>

#include <gtest/gtest.h>

namespace waymark {
namespace {

class ModuleFolder final : public testing::Environment {
 public:
  void SetUp() override { ASSERT_EQ(setenv("WAYMARK_MODULE_DIR", WAYMARK_MODULE_DIR, 1), 0); }
};

[[maybe_unused]] const auto* const kModuleFolder = testing::AddGlobalTestEnvironment(new ModuleFolder);

}  // namespace
}  // namespace waymark
