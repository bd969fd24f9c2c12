#include "workbench/run/choose_run.hpp"

#include <gtest/gtest.h>

namespace waymark {
namespace {

TEST(ChooseRun, CountsFromOneAndTellsHowManyThereAre) {
  EXPECT_EQ(*choose_run("log", {"log/a", "log/b"}, 1), "log/a");
  EXPECT_EQ(*choose_run("log", {"log/a", "log/b"}, 2), "log/b");
  EXPECT_EQ(choose_run("log", {"log/a", "log/b"}, 3).error().message,
            "log: no run 3; input.run can be 1 to 2");
}

}  // namespace
}  // namespace waymark
