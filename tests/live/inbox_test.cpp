#include "workbench/live/inbox.hpp"

#include <thread>

#include <gtest/gtest.h>

namespace waymark::live {
namespace {

using std::chrono::milliseconds;
using Clock = std::chrono::steady_clock;

Arrival image(double t_s, std::uint16_t device = 0) {
  return {Event(stamp_from_seconds(t_s), {0, device}, Image{}), stamp_from_seconds(t_s)};
}
Arrival speed(double t_s) { return {Event(stamp_from_seconds(t_s), Velocity{}), stamp_from_seconds(t_s)}; }

TEST(Inbox, GivesWhatArrivedInItsOrder) {
  Inbox inbox;
  for (int i = 0; i < 5; ++i) EXPECT_EQ(inbox.push(speed(i)), Inbox::Outcome::kTaken);
  std::vector<Arrival> arrivals;
  inbox.take(arrivals, Clock::now());
  ASSERT_EQ(arrivals.size(), 5U);
  for (std::size_t i = 0; i < 5; ++i)
    EXPECT_EQ(arrivals[i].arrived, stamp_from_seconds(static_cast<double>(i)));
  inbox.take(arrivals, Clock::now());
  EXPECT_TRUE(arrivals.empty());
}

TEST(Inbox, KeepsOnlyTheNewestImageOfEachCamera) {
  Inbox inbox;
  EXPECT_EQ(inbox.push(image(1.0)), Inbox::Outcome::kTaken);
  EXPECT_EQ(inbox.push(image(1.0, 1)), Inbox::Outcome::kTaken);
  EXPECT_EQ(inbox.push(speed(1.5)), Inbox::Outcome::kTaken);
  EXPECT_EQ(inbox.push(image(2.0)), Inbox::Outcome::kReplaced);
  std::vector<Arrival> arrivals;
  inbox.take(arrivals, Clock::now());
  ASSERT_EQ(arrivals.size(), 3U);
  EXPECT_EQ(arrivals[0].event.stream.device, 1);
  EXPECT_EQ(arrivals[2].event.stamp, stamp_from_seconds(2.0));
}

TEST(Inbox, HasAnEnd) {
  Inbox inbox;
  for (std::size_t i = 0; i < Inbox::kMost; ++i) EXPECT_EQ(inbox.push(speed(0.0)), Inbox::Outcome::kTaken);
  EXPECT_EQ(inbox.push(speed(0.0)), Inbox::Outcome::kDropped);
}

TEST(Inbox, WakesWhoWaits) {
  Inbox inbox;
  std::jthread later([&] {
    std::this_thread::sleep_for(milliseconds(20));
    inbox.push(speed(1.0));
  });
  std::vector<Arrival> arrivals;
  inbox.take(arrivals, Clock::now() + std::chrono::seconds(60));
  EXPECT_EQ(arrivals.size(), 1U);
}

}  // namespace
}  // namespace waymark::live
