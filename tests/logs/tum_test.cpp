#include "workbench/logs/tum.hpp"

#include <cmath>

#include <gmock/gmock.h>

#include "support/io_support.hpp"
#include "waymark/core/random.hpp"
#include "waymark/core/trajectory.hpp"

#include "workbench/logs/trajectory_file.hpp"

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
  const auto read = read_trajectory(file);
  ASSERT_TRUE(read.ok()) << read.error().message;
  EXPECT_TRUE(read->notes.empty());
  ASSERT_EQ(read->path.size(), written.size());
  for (std::size_t i = 0; i < written.size(); ++i) {
    const SpacePose& pose = read->path[i];
    EXPECT_EQ(pose.stamp, written[i].stamp);
    EXPECT_EQ(pose.p_m.z(), 0.0);
    const Pose2 planar{pose.p_m.x(), pose.p_m.y(), wrap_angle(2.0 * std::atan2(pose.q.z(), pose.q.w()))};
    EXPECT_LT(difference(planar, written[i].pose).cwiseAbs().maxCoeff(), 5e-9);
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
    EXPECT_EQ(read_trajectory(file).value().path.size(), 1U);
    writer.write(Stamp{}, {});
  }
  EXPECT_EQ(read_trajectory(file).value().path.size(), 2U);
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

}  // namespace
}  // namespace waymark
