#include "workbench/datasets/mat_structure.hpp"

#include <gmock/gmock.h>

#include "datasets/mat_support.hpp"

namespace waymark {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

const Eigen::MatrixXd kValues = Eigen::MatrixXd::Constant(3, 2, 1.5);

std::string structure_error(const std::string& bytes) {
  const auto checked = check_mat_structure(bytes, "x.mat");
  return checked ? "" : checked.error().message;
}

TEST(MatStructure, PlainAndCompressedMatricesPass) {
  const std::string variable = test::mat_variable("GT", kValues);
  EXPECT_EQ(structure_error(test::mat_header()), "");
  EXPECT_EQ(structure_error(test::mat_header() + variable), "");
  EXPECT_EQ(structure_error(test::mat_header() + test::mat_compressed(variable) + variable), "");
}

TEST(MatStructure, NumbersMayBeKeptInSmallerTypes) {
  const std::uint32_t flags[2] = {6, 0};
  const std::int32_t dimensions[2] = {1, 3};
  const std::string small("\x02\x00\x03\x00\x01\x02\x03\x00", 8);  // three uint8 within the tag
  const std::string inner = test::mat_element(6, test::bytes_of(flags, 8)) +
                            test::mat_element(5, test::bytes_of(dimensions, 8)) + test::mat_element(1, "v") +
                            small;
  EXPECT_EQ(structure_error(test::mat_header() + test::mat_element(14, inner)), "");
}

TEST(MatStructure, OtherFilesAreNamedAsWhatTheyAre) {
  EXPECT_THAT(structure_error(""), HasSubstr("no header of a level 5 file"));
  EXPECT_THAT(structure_error("stamp_s,id\n"), StartsWith("x.mat: is not a MATLAB file that can be read"));
  EXPECT_THAT(structure_error("MATLAB 7.3 MAT-file"), HasSubstr("level 7.3; save it as level 5 (-v7)"));
  std::string big_endian = test::mat_header();
  big_endian.replace(124, 4, "\x01\x00MI", 4);
  EXPECT_THAT(structure_error(big_endian), HasSubstr("unsupported version or byte order"));
}

TEST(MatStructure, DamageIsNamedWithItsPlace) {
  const std::string variable = test::mat_variable("GT", kValues);
  std::string packed = test::mat_compressed(variable);
  packed[packed.size() - 1] ^= 1;  // in the checksum
  EXPECT_THAT(
      structure_error(test::mat_header() + variable + packed),
      HasSubstr("at byte " + std::to_string(128 + variable.size()) + ", compressed data that is damaged"));
  EXPECT_THAT(structure_error(test::mat_header() + variable.substr(0, variable.size() - 8)),
              HasSubstr("at byte 128, an element that ends after the end of the file"));
  EXPECT_THAT(structure_error(test::mat_header() + test::mat_compressed("nothing of the kind")),
              HasSubstr("compressed data that is not a variable"));
  EXPECT_THAT(structure_error(test::mat_header() + test::mat_element(7, "abcd")),
              HasSubstr("an element of an unknown type"));
}

TEST(MatStructure, SizesMustAgreeWithTheContent) {
  std::string variable = test::mat_variable("GT", kValues);
  constexpr std::size_t kRows = 8 + 16 + 8;
  variable[kRows] = 4;
  EXPECT_THAT(structure_error(test::mat_header() + variable),
              HasSubstr("variable GT whose number of values is not the one stated"));
  variable.replace(kRows, 8, "\xff\xff\xff\xff\xff\xff\xff\xff", 8);
  EXPECT_THAT(structure_error(test::mat_header() + variable), HasSubstr("variable GT"));
}

TEST(MatStructure, CellsArePlainMatricesWithoutNames) {
  const std::string cells = test::mat_cells("zt", {kValues, Eigen::MatrixXd::Zero(3, 0)});
  EXPECT_EQ(structure_error(test::mat_header() + cells), "");
  EXPECT_EQ(structure_error(test::mat_header() + test::mat_compressed(cells)), "");
  constexpr std::size_t kColumns = 8 + 16 + 8 + 4;
  std::string fewer = cells;
  fewer[kColumns] = 1;
  EXPECT_THAT(structure_error(test::mat_header() + fewer),
              HasSubstr("variable zt whose number of cells is not the one stated"));
  constexpr std::size_t kFirstCell = 8 + 16 + 16 + 16;
  std::string broken = cells;
  broken[kFirstCell + 8 + 8] = 4;  // class char
  EXPECT_THAT(structure_error(test::mat_header() + broken),
              HasSubstr("variable zt with a cell which is not a matrix of real numbers"));
  broken = cells;
  broken[kFirstCell] = 9;
  EXPECT_THAT(structure_error(test::mat_header() + broken),
              HasSubstr("variable zt with a cell that is not a matrix"));
}

TEST(MatStructure, TextAndComplexNumbersAreRefused) {
  constexpr std::size_t kFlags = 8 + 8;
  std::string variable = test::mat_variable("names", kValues);
  variable[kFlags] = 4;  // class char
  EXPECT_THAT(structure_error(test::mat_header() + variable),
              HasSubstr("variable names, which is not a matrix of real numbers"));
  variable[kFlags] = 6;
  variable[kFlags + 1] = 8;  // complex
  EXPECT_THAT(structure_error(test::mat_header() + variable), HasSubstr("not a matrix of real numbers"));
}

TEST(MatStructure, EveryTruncationIsFound) {
  const std::string variable = test::mat_variable("GT", Eigen::MatrixXd::Random(5, 4));
  const std::string cells = test::mat_cells("zt", {kValues, Eigen::MatrixXd::Random(2, 2)});
  for (const std::string& content : {variable, cells, test::mat_compressed(variable)}) {
    const std::string file = test::mat_header() + content;
    for (std::size_t size = 0; size < file.size(); ++size) {
      if (size == test::mat_header().size()) continue;  // a file without variables
      EXPECT_NE(structure_error(file.substr(0, size)), "") << size;
    }
  }
}

}  // namespace
}  // namespace waymark
