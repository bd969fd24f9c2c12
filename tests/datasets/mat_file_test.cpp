#include "workbench/datasets/mat_file.hpp"

#include <limits>

#include <gmock/gmock.h>

#include "support/io_support.hpp"

#include "datasets/mat_support.hpp"

namespace waymark {
namespace {

using test::TempFolder;
using testing::HasSubstr;

TEST(MatFile, ReadsPlainAndCompressedMatricesColumnByColumn) {
  const TempFolder folder;
  const Eigen::MatrixXd a = Eigen::MatrixXd::Random(7, 3);
  const Eigen::MatrixXd b = Eigen::MatrixXd::Random(1, 2);
  const auto file =
      MatFile::open(folder.write("x.mat", test::mat_header() + test::mat_variable("a", a) +
                                              test::mat_compressed(test::mat_variable("some_name", b))));
  ASSERT_TRUE(file.ok()) << file.error().message;
  EXPECT_EQ(file->names(), "a, some_name");
  EXPECT_TRUE(file->has_all({"a", "some_name"}));
  EXPECT_FALSE(file->has("b"));
  EXPECT_EQ(file->matrix("a", 3, "").value(), a);
  EXPECT_EQ(file->matrix("some_name", 2, "").value(), b);
}

TEST(MatFile, ReadsVectorsThatStandOrLieAndCells) {
  const TempFolder folder;
  const Eigen::MatrixXd a = Eigen::MatrixXd::Random(2, 3);
  const std::vector<Eigen::MatrixXd> cells{a, Eigen::MatrixXd::Zero(2, 0)};
  const auto file =
      MatFile::open(folder.write("x.mat", test::mat_header() + test::mat_variable("a", a) +
                                              test::mat_variable("row", a.row(0)) +
                                              test::mat_variable("column", a.col(0)) +
                                              test::mat_compressed(test::mat_cells("cells", cells))))
          .value();
  EXPECT_EQ(file.names(), "a, column, row, cells");
  EXPECT_TRUE(file.has("cells"));
  EXPECT_EQ(file.transposed("a", 2, "").value(), a.transpose());
  EXPECT_EQ(file.vector("row", "").value(), a.row(0).transpose());
  EXPECT_EQ(file.vector("column", "").value(), a.col(0));
  EXPECT_THAT(file.vector("a", "m").error().message, HasSubstr("variable a has 3 columns; expected 1 (m)"));
  EXPECT_EQ(file.cells("cells", 2, "").value(), cells);
  EXPECT_THAT(file.cells("cells", 3, "x, y, z").error().message,
              HasSubstr("variable cells: cell 1 has 2 rows; expected 3 (x, y, z)"));
  EXPECT_THAT(file.cells("a", 2, "x, y").error().message, HasSubstr("variable a (x, y) is missing"));
}

TEST(MatFile, WrongShapesAndValuesAreNamed) {
  const TempFolder folder;
  Eigen::MatrixXd values = Eigen::MatrixXd::Zero(4, 2);
  values(2, 1) = std::numeric_limits<double>::quiet_NaN();
  const auto file =
      MatFile::open(folder.write("x.mat", test::mat_header() + test::mat_variable("a", values))).value();
  EXPECT_THAT(file.matrix("a", 3, "x, y, z").error().message,
              HasSubstr("x.mat: variable a has 2 columns; expected 3 (x, y, z)"));
  EXPECT_THAT(file.matrix("a", 2, "x, y").error().message, HasSubstr("variable a: row 3 is not finite"));
  EXPECT_THAT(file.matrix("c", 2, "x, y").error().message,
              HasSubstr("variable c (x, y) is missing; it holds a"));
}

TEST(MatFile, FileThatIsNotThereOrNoMatlabFileIsAnError) {
  const TempFolder folder;
  EXPECT_THAT(MatFile::open(folder.path() / "x.mat").error().message, HasSubstr("x.mat"));
  EXPECT_THAT(MatFile::open(folder.write("x.mat", "nothing")).error().message,
              HasSubstr("is not a MATLAB file that can be read"));
}

// Some bits between the parts of compressed data mean nothing.
TEST(MatFile, FlippedBitOfCompressedDataIsFoundOrChangesNothing) {
  const TempFolder folder;
  const Eigen::MatrixXd values = Eigen::MatrixXd::Random(5, 4);
  const std::string bytes = test::mat_header() + test::mat_compressed(test::mat_variable("GT", values));
  int found = 0;
  for (std::size_t byte = 128; byte < bytes.size(); ++byte) {
    for (int bit = 0; bit < 8; ++bit) {
      std::string flipped = bytes;
      flipped[byte] = static_cast<char>(flipped[byte] ^ (1 << bit));
      const auto file = MatFile::open(folder.write("x.mat", flipped));
      found += file ? 0 : 1;
      if (file) {
        EXPECT_EQ(file->matrix("GT", 4, "").value(), values) << byte << "." << bit;
      }
    }
  }
  EXPECT_GT(found, static_cast<int>(bytes.size() - 128) * 8 * 9 / 10);
}

// Whatever passes the check of the structure must be safe for the library that reads it.
TEST(MatFile, NoFlippedByteOfAnUncompressedFileIsFatal) {
  const TempFolder folder;
  const std::string bytes = test::mat_header() + test::mat_variable("GT", Eigen::MatrixXd::Random(2, 4)) +
                            test::mat_cells("zt", {Eigen::MatrixXd::Random(1, 2)}) +
                            test::mat_variable("d", Eigen::MatrixXd::Random(1, 1));
  int readable = 0;
  for (std::size_t byte = 116; byte < bytes.size(); ++byte) {
    for (const int value : {0x00, 0x01, 0x7f, 0x80, 0xff}) {
      std::string changed = bytes;
      changed[byte] = static_cast<char>(value);
      const auto file = MatFile::open(folder.write("x.mat", changed));
      if (!file) {
        EXPECT_THAT(file.error().message, HasSubstr("x.mat"));
        continue;
      }
      ++readable;
      EXPECT_NE(file->names(), "");
    }
  }
  EXPECT_GT(readable, 0);
}

}  // namespace
}  // namespace waymark
