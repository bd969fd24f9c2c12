#include "workbench/live/recorder.hpp"

#include <algorithm>

#include <gtest/gtest.h>

#include "support/stamps.hpp"

#include "workbench/bags/live_recording.hpp"
#include "workbench/run/config.hpp"

namespace waymark::live {
namespace {

using test::at;

std::string path(const char* name) { return testing::TempDir() + "/" + name; }

GreyImage image(std::uint8_t grey) {
  GreyImage made(4, 3);
  std::fill_n(made.data(), 4 * 3, grey);
  return made;
}

TEST(Recorder, KeepsEventsAndWhatWasProcessedBeforeEach) {
  const std::string file = path("session.mcap");
  {
    auto recorder = Recorder::open(file, "drive", "seed: 7\nwheels:\n  track_m: 0.3\n", at(1.0)).value();
    recorder->hold(Event(at(1.0), {0, 2}, WheelAngles{0.1, 0.2}), at(1.01));
    recorder->process_until(at(0.5));
    recorder->process_until(at(1.0));
    recorder->hold(Event(at(1.5), {0, 3}, Observations{{std::nullopt, Range{2.0}, std::nullopt}}), at(1.6));
    recorder->add({at(1.5), {}});
    recorder->hold(Event(at(2.0), {0, 4}, Image{"", std::make_shared<const GreyImage>(image(200)), nullptr}),
                   at(2.1));
    recorder->hold(Event(at(2.5), Truth{1.0, 2.0, {}}), at(2.5));
    recorder->process_until(at(2.0));
    ASSERT_TRUE(recorder->close().ok());
  }
  ASSERT_TRUE(is_live_recording(file));
  const auto source = open_live_recording(file).value();
  EXPECT_EQ(source->info().name, "drive");
  EXPECT_EQ(source->info().settings,
            (std::vector<std::pair<std::string, std::string>>{{"seed", "7"}, {"wheels.track_m", "0.3"}}));
  auto event = *source->next().value();
  EXPECT_EQ(event.stamp, at(1.0));
  EXPECT_EQ(event.stream.device, 2);
  EXPECT_EQ(std::get<WheelAngles>(event.content).right_rad, 0.2);
  EXPECT_FALSE(source->replay()->until);
  event = *source->next().value();
  EXPECT_EQ(std::get<Range>(std::get<Observations>(event.content)[0].value).range_m, 2.0);
  EXPECT_EQ(source->replay()->until, at(1.0));
  event = *source->next().value();
  EXPECT_EQ(event.stamp, at(2.0));
  EXPECT_EQ(event.stream.device, 4);
  EXPECT_TRUE(std::get<Image>(event.content).encoded);
  EXPECT_FALSE(source->replay()->until);  // that was told before the event before
  EXPECT_FALSE(*source->next());
}

TEST(Recorder, SaysThatTheDiskIsFullAndGoesOn) {
  auto recorder = Recorder::open("/dev/full", "drive", "seed: 7\n", at(0.0)).value();
  for (int i = 0; i < 1000 && recorder->fault().empty(); ++i) {
    recorder->hold(Event(at(i), WheelAngles{0.1 * i, 0.0}), at(i));
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  EXPECT_NE(recorder->fault().find("full"), std::string::npos);
  const auto closed = recorder->close();
  ASSERT_FALSE(closed.ok());
  EXPECT_EQ(closed.error().kind, Error::Kind::kFailed);
}

}  // namespace
}  // namespace waymark::live
