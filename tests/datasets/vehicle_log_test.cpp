#include "workbench/datasets/vehicle_log.hpp"

#include <gmock/gmock.h>

#include "support/io_support.hpp"

#include "datasets/mat_support.hpp"

namespace waymark {
namespace {

using test::TempFolder;
using testing::HasSubstr;

Fix fix(double time_s, double east_m, double north_m = 0.0) {
  return {stamp_from_seconds(time_s), {east_m, north_m}};
}

TEST(CleanFixes, AreThoseThatBothNeighboursConfirm) {
  const std::vector<Fix> fixes{fix(0, 0),    fix(0.2, 1),   fix(0.4, 2), fix(0.6, 30),  // jumps
                               fix(0.8, 4),  fix(1.0, 5),   fix(1.2, 6), fix(9.0, 60),  // alone
                               fix(20.0, 0), fix(20.2, 0.1)};
  const auto clean = clean_fixes(fixes);
  ASSERT_EQ(clean.size(), 2U);
  EXPECT_EQ(clean[0].position_m.x(), 1.0);
  EXPECT_EQ(clean[1].position_m.x(), 5.0);
  EXPECT_TRUE(clean_fixes({}).empty());
  EXPECT_TRUE(clean_fixes({fix(0, 0)}).empty());
}

MatFile with_times(const TempFolder& folder, const Eigen::MatrixXd& times) {
  return MatFile::open(folder.write("x.mat", test::mat_header() + test::mat_variable("t", times) +
                                                 test::mat_variable("east", Eigen::MatrixXd{{1.0, 2.0}}) +
                                                 test::mat_variable("north", Eigen::MatrixXd{{3.0}, {4.0}})))
      .value();
}

TEST(ReadStamps, TakesAColumnOrARowInAnyUnit) {
  const TempFolder folder;
  const auto column = read_stamps(with_times(folder, Eigen::MatrixXd{{1500.0}, {1500.0}}), "t", 1e-3);
  EXPECT_EQ(column.value(), std::vector<Stamp>(2, stamp_from_seconds(1.5)));
  const auto row = read_stamps(with_times(folder, Eigen::MatrixXd{{1.5, 2.5}}), "t", 1.0);
  EXPECT_EQ(row.value()[1], stamp_from_seconds(2.5));
}

TEST(ReadStamps, NamesWhatIsNoTime) {
  const TempFolder folder;
  EXPECT_THAT(read_stamps(with_times(folder, Eigen::MatrixXd{{2.0, 1.0}}), "t", 1.0).error().message,
              HasSubstr("x.mat: variable t: value 2 goes back in time"));
  EXPECT_THAT(read_stamps(with_times(folder, Eigen::MatrixXd{{1e12}}), "t", 1.0).error().message,
              HasSubstr("value 1 is not a time"));
}

TEST(ReadFixes, NeedsAsManyPlacesAsTimes) {
  const TempFolder folder;
  const auto two = read_fixes(with_times(folder, Eigen::MatrixXd{{1.0, 2.0}}), "t", 1.0, "east", "north");
  ASSERT_TRUE(two.ok()) << two.error().message;
  EXPECT_EQ((*two)[1].position_m, Eigen::Vector2d(2.0, 4.0));
  const auto three =
      read_fixes(with_times(folder, Eigen::MatrixXd{{1.0, 2.0, 3.0}}), "t", 1.0, "east", "north");
  EXPECT_THAT(three.error().message, HasSubstr("variable east has 2 values for 3 times"));
}

}  // namespace
}  // namespace waymark
