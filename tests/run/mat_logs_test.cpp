#include "workbench/run/mat_logs.hpp"

#include <gmock/gmock.h>

#include "support/io_support.hpp"

#include "datasets/mat_support.hpp"
#include "workbench/run/input_formats.hpp"

namespace waymark {
namespace {

using test::TempFolder;
using testing::HasSubstr;

TEST(MatLogs, AreKnownByTheirNameOrWhatLiesInTheFolder) {
  const TempFolder folder;
  const auto other = folder.write("a.txt", "");
  EXPECT_FALSE(is_mat_log(folder.path()));
  EXPECT_FALSE(is_mat_log(other));
  EXPECT_TRUE(is_mat_log(folder.write("a.mat", "")));
  EXPECT_TRUE(is_mat_log(folder.path()));
}

TEST(MatLogs, VariablesOfNoLogAreNamedBesideThoseOfAll) {
  const TempFolder folder;
  const auto file =
      folder.write("a.mat", test::mat_header() + test::mat_variable("other", Eigen::MatrixXd::Zero(1, 1)));
  const std::string error = open_mat_log(file, {}).error().message;
  for (const MatFormat& format : mat_formats())
    EXPECT_THAT(error, HasSubstr(format.name + " (" + format.expects + ")"));
  EXPECT_THAT(error, HasSubstr("found other"));
}

TEST(MatLogs, TheFileThatAFormatNamesRanksAboveTheRun) {
  for (const MatFormat& format : mat_formats()) {
    if (format.file.empty()) continue;
    const TempFolder folder;
    folder.write("0.mat", "");
    folder.write(format.file, "");
    for (const int run : {1, 2, 3})
      EXPECT_THAT(open_mat_log(folder.path(), {.run = run}).error().message, HasSubstr(format.file));
  }
}

}  // namespace
}  // namespace waymark
