#include "workbench/bags/time_order.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "support/stamps.hpp"

namespace waymark::bag {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using waymark::test::at;

constexpr double kNoHeader = -1.0;

/// What the clocks of recorder and header say at a time of the drive.
struct Clocks {
  std::function<double(double t_s)> recorded = [](double t_s) { return t_s; };
  std::function<double(double t_s)> header = [](double t_s) { return t_s; };
};

/// A topic with a message every `step_s` from `from_s` to before `to_s`.
TopicTimes times_of(const std::string& name, double step_s, const Clocks& clocks = {}, double from_s = 1000.0,
                    double to_s = 1060.0) {
  TopicTimes times{name, {}};
  for (std::uint32_t i = 0; from_s + step_s * i < to_s - 1e-6; ++i) {
    const double t_s = from_s + step_s * i;
    const double header_s = clocks.header(t_s);
    times.messages.push_back({at(clocks.recorded(t_s)), std::nullopt, i, true});
    if (header_s != kNoHeader) times.messages.back().header = at(header_s);
  }
  return times;
}

/// The worst that a stamp is off from the time of the drive, s; of those that are used.
double error_s(const TimeOrder& order, std::size_t topic, double step_s, double from_s = 1000.0) {
  double worst_s = 0.0;
  for (std::size_t i = 0; i < order.stamps[topic].size(); ++i)
    if (const Stamp stamp = order.stamps[topic][i]; stamp != TimeOrder::kSkipped)
      worst_s = std::max(worst_s, std::abs(to_seconds(stamp - at(from_s + step_s * static_cast<double>(i)))));
  return worst_s;
}

std::ptrdiff_t skipped(const TimeOrder& order, std::size_t topic) {
  return std::ranges::count(order.stamps[topic], TimeOrder::kSkipped);
}

TEST(TimeOrder, TakesTheStampsOfHeadersAsTheyAre) {
  const Clocks late{[](double t_s) { return t_s + 0.1; }, [](double t_s) { return t_s; }};
  const auto order = find_time_order({times_of("/odom", 0.05), times_of("/tags", 0.2, late)}, true);
  EXPECT_EQ(error_s(order, 0, 0.05), 0.0);
  EXPECT_EQ(error_s(order, 1, 0.2), 0.0);
  EXPECT_THAT(order.notes, IsEmpty());
}

TEST(TimeOrder, TakesTimesOfRecordingWhereAsked) {
  const Clocks ahead{[](double t_s) { return t_s; }, [](double t_s) { return t_s + 500.0; }};
  const auto order = find_time_order({times_of("/odom", 0.05, ahead)}, false);
  EXPECT_EQ(error_s(order, 0, 0.05), 0.0);
  EXPECT_THAT(order.notes, IsEmpty());
}

TEST(TimeOrder, OneOffsetOfAllTopicsIsNoFault) {
  const Clocks simulated{[](double t_s) { return t_s; }, [](double t_s) { return t_s - 990.0; }};
  const auto order =
      find_time_order({times_of("/odom", 0.05, simulated), times_of("/tags", 0.2, simulated)}, true);
  EXPECT_NEAR(error_s(order, 0, 0.05, 10.0), 0.0, 1e-6);
  EXPECT_NEAR(error_s(order, 1, 0.2, 10.0), 0.0, 1e-6);
  EXPECT_THAT(order.notes, IsEmpty());
}

TEST(TimeOrder, BelievesADetectorThatIsLate) {
  const Clocks late{[](double t_s) { return t_s + 8.0; }, [](double t_s) { return t_s; }};
  const auto order = find_time_order({times_of("/odom", 0.05), times_of("/tags", 0.2, late)}, true);
  EXPECT_EQ(error_s(order, 1, 0.2), 0.0);
  EXPECT_THAT(order.notes, ElementsAre(AllOf(HasSubstr("/tags are 8.0 s behind those of /odom"),
                                             HasSubstr("input.stamps"))));
}

TEST(TimeOrder, PutsAnotherClockOnThatOfTheFirstTopic) {
  for (const double off_s : {-10800.0, 10800.0, -990.0, 1.7e9}) {
    const Clocks other{[](double t_s) { return t_s; }, [off_s](double t_s) { return t_s + off_s; }};
    const auto order = find_time_order({times_of("/odom", 0.05), times_of("/tags", 0.2, other)}, true);
    EXPECT_NEAR(error_s(order, 0, 0.05), 0.0, 1e-6);
    EXPECT_NEAR(error_s(order, 1, 0.2), 0.0, 1e-6);
    EXPECT_THAT(order.notes, ElementsAre(AllOf(HasSubstr("/tags"), HasSubstr("those of /odom: another clock"),
                                               HasSubstr("input.stamps=recorded"))));
  }
}

TEST(TimeOrder, TopicsWithoutHeaderAreOnTheClockOfTheRecording) {
  const Clocks none{[](double t_s) { return t_s; }, [](double) { return kNoHeader; }};
  const Clocks simulated{[](double t_s) { return t_s; }, [](double t_s) { return t_s - 1000.0; }};
  TopicTimes commands = times_of("/cmd_vel", 0.1, none);
  for (MessageTime& message : commands.messages) message.expects_a_header = false;
  const auto order = find_time_order({commands, times_of("/tags", 0.2, simulated)}, true);
  EXPECT_NEAR(error_s(order, 0, 0.1), 0.0, 1e-6);
  EXPECT_NEAR(error_s(order, 1, 0.2), 0.0, 1e-6);
}

TEST(TimeOrder, GoesOnBehindAClockThatWasSetBack) {
  for (const double back_s : {3600.0, 20.0, 10.0, 86400.0}) {
    const auto set = [back_s](double t_s) { return t_s < 1029.99 ? t_s : t_s - back_s; };
    const auto order =
        find_time_order({times_of("/odom", 0.05, {set, set}), times_of("/tags", 0.2, {set, set}),
                         times_of("/truth", 0.1, {set, set})},
                        true);
    EXPECT_NEAR(error_s(order, 0, 0.05), 0.0, 1e-6) << back_s;
    EXPECT_NEAR(error_s(order, 1, 0.2), 0.0, 1e-6) << back_s;
    EXPECT_NEAR(error_s(order, 2, 0.1), 0.0, 1e-6) << back_s;
    EXPECT_THAT(order.notes, ElementsAre(HasSubstr(fmt::format("set back by {:.1f} s", back_s))));
  }
}

TEST(TimeOrder, AClockOfTheRecordingAloneThatWasSetBackMovesNoHeader) {
  const Clocks clocks{[](double t_s) { return t_s < 1029.99 ? t_s : t_s - 3600.0; },
                      [](double t_s) { return t_s; }};
  const auto order = find_time_order({times_of("/odom", 0.05, clocks), times_of("/tags", 0.2, clocks)}, true);
  EXPECT_NEAR(error_s(order, 0, 0.05), 0.0, 1e-6);
  EXPECT_NEAR(error_s(order, 1, 0.2), 0.0, 1e-6);
}

TEST(TimeOrder, UndoesTheSettingOfAClockWhileTheRecordingGoesOn) {
  for (const double set_s : {3600.0, -3600.0}) {
    const Clocks clocks{[](double t_s) { return t_s; },
                        [set_s](double t_s) { return t_s < 1039.99 ? t_s : t_s + set_s; }};
    const auto order =
        find_time_order({times_of("/odom", 0.05, clocks), times_of("/tags", 0.2, clocks)}, true);
    EXPECT_NEAR(error_s(order, 0, 0.05), 0.0, 1e-6);
    EXPECT_NEAR(error_s(order, 1, 0.2), 0.0, 1e-6);
    EXPECT_EQ(skipped(order, 0), 0);
    EXPECT_THAT(order.notes,
                Contains(AllOf(HasSubstr("/odom"), HasSubstr("3600.0 s"), HasSubstr("input.stamps"))));
  }
}

TEST(TimeOrder, PartsInAnotherOrderAreNoClockThatWasSet) {
  for (const std::vector<double>& starts_s :
       {std::vector{1030.0, 1000.0}, {1020.0, 1000.0, 1040.0}, {1040.0, 1020.0, 1000.0}}) {
    const double length_s = 60.0 / static_cast<double>(starts_s.size());
    TopicTimes shuffled{"/odom", {}};
    for (const double start_s : starts_s)
      std::ranges::copy(times_of("", 0.05, {}, start_s, start_s + length_s).messages,
                        std::back_inserter(shuffled.messages));
    const auto order = find_time_order({shuffled}, true);
    for (std::size_t i = 0; i < shuffled.messages.size(); ++i)
      EXPECT_EQ(order.stamps[0][i], shuffled.messages[i].recorded);
    EXPECT_THAT(order.notes, IsEmpty());
  }
}

TEST(TimeOrder, ATopicThatGoesBackAloneIsNoClockThatWasSet) {
  TopicTimes two_detectors = times_of("/tags", 0.2);
  std::ranges::copy(times_of("", 0.19, {}, 1000.1).messages, std::back_inserter(two_detectors.messages));
  for (std::size_t i = 300; i < two_detectors.messages.size(); ++i) two_detectors.messages[i].content += 1000;
  const auto order = find_time_order({times_of("/odom", 0.05), two_detectors}, true);
  EXPECT_EQ(order.stamps[1].back(), two_detectors.messages.back().recorded);
  EXPECT_THAT(order.notes, IsEmpty());
}

TEST(TimeOrder, ARecordingThatIsThereTwiceIsUsedOnce) {
  TopicTimes twice = times_of("/odom", 0.05);
  std::ranges::copy(times_of("", 0.05).messages, std::back_inserter(twice.messages));
  const auto order = find_time_order({twice}, true);
  EXPECT_EQ(skipped(order, 0), 1200);
  EXPECT_EQ(order.stamps[0][1199], at(1059.95));
  EXPECT_THAT(order.notes, ElementsAre(HasSubstr("/odom skipped that are there twice: 1200")));
}

TEST(TimeOrder, AStampThatStandsStillGoesOnWithTheRecording) {
  const Clocks frozen{[](double t_s) { return t_s + 0.01; },
                      [](double t_s) { return t_s < 1020.0 || t_s > 1040.0 ? t_s : 1020.0; }};
  const auto order = find_time_order({times_of("/odom", 0.05, frozen)}, true);
  EXPECT_NEAR(error_s(order, 0, 0.05), 0.0, 1e-6);
  EXPECT_THAT(order.notes, ElementsAre(HasSubstr("/odom whose stamp stands still")));
}

TEST(TimeOrder, StampsInWholeSecondsGoOnWithTheRecording) {
  const Clocks whole{[](double t_s) { return t_s; }, [](double t_s) { return std::floor(t_s + 1e-6); }};
  const auto order = find_time_order({times_of("/odom", 0.05, whole)}, true);
  EXPECT_NEAR(error_s(order, 0, 0.05), 0.0, 1e-6);
}

TEST(TimeOrder, MessagesOfOneMomentKeepTheirStamp) {
  const Clocks bursts{[](double t_s) { return t_s; },
                      [](double t_s) { return std::floor(t_s * 5.0 + 1e-6) / 5.0; }};
  const auto times = times_of("/tags", 0.05, bursts);
  const auto order = find_time_order({times}, true);
  for (std::size_t i = 0; i < times.messages.size(); ++i)
    EXPECT_EQ(order.stamps[0][i], *times.messages[i].header);
}

TEST(TimeOrder, SkipsSingleStampsThatJump) {
  TopicTimes odometry = times_of("/odom", 0.05);
  odometry.messages[0].header = at(0.0);
  odometry.messages[5].header = at(1500.0);
  odometry.messages[6].header = at(900.0);
  const auto order = find_time_order({odometry}, true);
  EXPECT_EQ(order.stamps[0][0], TimeOrder::kSkipped);
  EXPECT_EQ(order.stamps[0][5], TimeOrder::kSkipped);
  EXPECT_EQ(order.stamps[0][6], TimeOrder::kSkipped);
  EXPECT_EQ(skipped(order, 0), 3);
  EXPECT_EQ(error_s(order, 0, 0.05), 0.0);
  EXPECT_THAT(order.notes,
              ElementsAre(AllOf(HasSubstr("/odom skipped whose stamp jumps"), HasSubstr(": 3"))));
}

TEST(TimeOrder, AMessageWithoutStampHasTheUsualDelay) {
  const Clocks late{[](double t_s) { return t_s + 0.25; },
                    [](double t_s) { return t_s < 1000.5 ? kNoHeader : t_s; }};
  const auto order = find_time_order({times_of("/odom", 0.05, late)}, true);
  EXPECT_NEAR(error_s(order, 0, 0.05), 0.0, 1e-6);
  EXPECT_THAT(order.notes,
              ElementsAre(HasSubstr("/odom without a stamp in the header, placed at their time of "
                                    "recording: 10")));
}

TEST(TimeOrder, APauseOfTheRecordingIsNoClockThatWasSet) {
  const auto pause = [](double t_s) { return t_s < 1030.0 ? t_s : t_s + 600.0; };
  const auto order = find_time_order(
      {times_of("/odom", 0.05, {pause, pause}), times_of("/tags", 0.2, {pause, pause})}, true);
  EXPECT_EQ(order.stamps[0].back(), at(1659.95));
  EXPECT_THAT(order.notes, IsEmpty());
}

TEST(TimeOrder, KnowsTheEarliestOfWhatIsStillToCome) {
  EXPECT_THAT(earliest_from({at(3.0), at(1.0), TimeOrder::kSkipped, at(2.0)}),
              ElementsAre(at(1.0), at(1.0), at(2.0), at(2.0)));
}

TEST(TimeOrder, MeasuresTheDisorderOfAFile) {
  TimeOrder order;
  order.stamps = {{at(1.0), at(2.0), at(9.0)}, {at(1.5), TimeOrder::kSkipped, at(3.5)}};
  const std::vector<std::uint32_t> interleaved{0, 1, 1, 0, 1, 0}, apart{0, 0, 0, 1, 1, 1};
  EXPECT_EQ(disorder(order, interleaved), Duration{0});
  EXPECT_EQ(disorder(order, apart), duration_from_seconds(7.5));
}

}  // namespace
}  // namespace waymark::bag
