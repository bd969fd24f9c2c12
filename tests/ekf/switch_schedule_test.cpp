#include "waymark/ekf/switch_schedule.hpp"

#include <gtest/gtest.h>

namespace waymark::ekf {
namespace {

constexpr double kWork = 1e6;
constexpr int kRoom = 40;

TEST(SwitchSchedule, SpreadsTheWorkEvenlyWhileThereIsRoom) {
  const SwitchSchedule schedule(kWork, kRoom);
  double remaining = kWork;
  int updates = 0;
  for (; remaining > 0.0; ++updates) {
    const double share = schedule.share(remaining, kRoom);
    ASSERT_DOUBLE_EQ(share, kWork / 256.0);
    remaining -= share;
  }
  EXPECT_NEAR(updates, 256, 1);
}

TEST(SwitchSchedule, LeavesNothingForAFullSubmap) {
  const SwitchSchedule schedule(kWork, kRoom);
  double remaining = kWork;
  for (int room = kRoom; room >= 0; --room) {
    remaining -= schedule.share(remaining, room);
    EXPECT_LE(remaining, kWork * 2.0 * room / kRoom + 1e-6);
  }
  EXPECT_LE(remaining, 1e-6);
}

TEST(SwitchSchedule, WithoutASwitchThereIsNothingToDo) { EXPECT_EQ(SwitchSchedule().share(0.0, 5), 0.0); }

}  // namespace
}  // namespace waymark::ekf
