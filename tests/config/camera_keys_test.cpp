#include "workbench/config/camera_keys.hpp"

#include <string>

#include <gtest/gtest.h>

namespace waymark {
namespace {

TEST(CameraKeys, HaveDefaultsWithinTheirLimits) {
  vision::SearchOptions search;
  vision::TrackerOptions tracker;
  markers::MarkerOptions markers;
  Schema schema;
  describe(schema, search);
  describe(schema, tracker);
  describe(schema, markers);
  ASSERT_TRUE(schema.load_text(schema.to_yaml(), "defaults").ok()) << "a default is beyond its own limits";
  ASSERT_TRUE(schema.set("tracker.budget", "clock", "test").ok());
  EXPECT_EQ(tracker.budget.kind, vision::BudgetKind::kClock);
  EXPECT_FALSE(schema.set("corners.threshold", "0", "test").ok());
}

}  // namespace
}  // namespace waymark
