#include "workbench/logs/tum.hpp"

#include <gmock/gmock.h>

#include "support/io_support.hpp"
#include "waymark/core/random.hpp"

namespace waymark {
namespace {

using test::TempFolder;
using testing::HasSubstr;

TEST(Tum, ReadsBackWhatWasWritten) {
  const TempFolder folder;
  const auto file = folder.path() / "t.tum";
  RandomStream random(4, StreamPurpose::kSimulation);
  Trajectory written;
  for (int i = 0; i < 2000; ++i)
    written.push_back({Stamp{Duration{1248444175103000001 + i}},
                       {random.normal() * 100.0, random.normal(), random.uniform(-kPi, kPi)},
                       std::nullopt});
  auto writer = TumWriter::open(file);
  ASSERT_TRUE(writer.ok());
  for (const auto& point : written) writer->write(point.stamp, point.pose);
  ASSERT_TRUE(writer->close().ok());
  const auto read = read_tum(file);
  ASSERT_TRUE(read.ok()) << read.error().message;
  ASSERT_EQ(read->size(), written.size());
  for (std::size_t i = 0; i < written.size(); ++i) {
    EXPECT_EQ((*read)[i].stamp, written[i].stamp);
    EXPECT_LT(difference((*read)[i].pose, written[i].pose).cwiseAbs().maxCoeff(), 5e-9);
  }
}

TEST(Tum, RowHasEightColumnsAndNineDecimals) {
  const TempFolder folder;
  const auto file = folder.path() / "t.tum";
  TumWriter::open(file).value().write(Stamp{Duration{1'500'000'000}}, {1.0, -2.0, kPi});
  EXPECT_EQ(read_file(file).value(), "1.500000000 1.000000000 -2.000000000 0 0 0 1.000000000 0.000000000\n");
}

TEST(Tum, WhatWasWrittenIsOnDiskAfterFlushAndAfterDestruction) {
  const TempFolder folder;
  const auto file = folder.path() / "t.tum";
  {
    auto opened = TumWriter::open(file);
    TumWriter writer = *std::move(opened);
    writer.write(Stamp{}, {});
    writer.flush();
    EXPECT_EQ(read_tum(file).value().size(), 1U);
    writer.write(Stamp{}, {});
  }
  EXPECT_EQ(read_tum(file).value().size(), 2U);
}

TEST(Tum, OutputThatCannotBeWrittenIsAnError) {
  const TempFolder folder;
  EXPECT_THAT(TumWriter::open(folder.path() / "none" / "t.tum").error().message, HasSubstr("cannot write"));
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full";
  auto full = TumWriter::open("/dev/full");
  ASSERT_TRUE(full.ok());
  full->write(Stamp{}, {});
  EXPECT_EQ(full->close().error().kind, Error::Kind::kFailed);
}

TEST(Tum, HeadingComesFromAnyQuaternionAboutTheVertical) {
  const TempFolder folder;
  const auto file = folder.write("t.tum", "# comment\n1 2 3 9 0 0 2 2\n2 2 3 9 0 0 -1 0\n");
  const auto read = read_tum(file);
  ASSERT_TRUE(read.ok()) << read.error().message;
  EXPECT_DOUBLE_EQ((*read)[0].pose.theta_rad, kPi / 2);
  EXPECT_DOUBLE_EQ((*read)[1].pose.theta_rad, kPi);
}

TEST(Tum, BadRowsAreErrorsWithTheirLine) {
  const TempFolder folder;
  const auto error_of = [&](const char* text) {
    return read_tum(folder.write("t.tum", text)).error().message;
  };
  EXPECT_THAT(error_of("1 2 3 0 0 0 0 1\n2 2 3 0 0 0"), HasSubstr("t.tum:2: expected 8 columns"));
  EXPECT_THAT(error_of("1 2 3 0 0 0 0 0\n"), HasSubstr("t.tum:1: the quaternion is zero"));
  EXPECT_THAT(error_of("1 nan 3 0 0 0 0 1\n"), HasSubstr("t.tum:1: 'nan'"));
  EXPECT_THAT(error_of("2 0 0 0 0 0 0 1\n1 0 0 0 0 0 0 1\n"), HasSubstr("t.tum:2: stamp"));
}

}  // namespace
}  // namespace waymark
