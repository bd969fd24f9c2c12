#include "waymark/core/background.hpp"

#include <stdexcept>
#include <system_error>
#include <thread>

#include <gtest/gtest.h>

#include "support/allocation_counter.hpp"
#include "support/no_more_threads.hpp"

namespace waymark {
namespace {

struct Counter {
  void fail() {
    ++calls;
    throw std::runtime_error("failed");
  }
  void count() {
    ++calls;
    caller = std::this_thread::get_id();
  }
  int calls = 0;
  std::thread::id caller;
};

TEST(Background, DoesAllJobsInTurnOnItsOwnThread) {
  Counter counter;
  Background background(true);
  for (int i = 0; i < 1000; ++i) background.start<&Counter::count>(&counter);
  background.wait();
  EXPECT_EQ(counter.calls, 1000);
  EXPECT_NE(counter.caller, std::this_thread::get_id());
}

TEST(Background, DoesAJobAtOnceWithoutAThread) {
  Counter counter;
  Background background(false);
  background.start<&Counter::count>(&counter);
  EXPECT_EQ(counter.calls, 1);
  EXPECT_EQ(counter.caller, std::this_thread::get_id());
  background.wait();
}

TEST(Background, EndsItsLastJobBeforeItGoes) {
  Counter counter;
  {
    Background background(true);
    background.start<&Counter::count>(&counter);
  }
  EXPECT_EQ(counter.calls, 1);
}

TEST(Background, ThrowsWhatAJobThrewToWhoeverWaitsOrStartsTheNext) {
  Counter counter;
  Background background(true);
  background.start<&Counter::fail>(&counter);
  EXPECT_THROW(background.wait(), std::runtime_error);
  background.wait();
  background.start<&Counter::fail>(&counter);
  EXPECT_THROW(background.start<&Counter::count>(&counter), std::runtime_error);
  background.start<&Counter::count>(&counter);
  background.wait();
  EXPECT_EQ(counter.calls, 3) << "the job that was refused was done, or the last one was not";
}

TEST(Background, MayGoWithoutAnybodyAskingWhatWasThrown) {
  Counter counter;
  {
    Background background(true);
    background.start<&Counter::fail>(&counter);
  }
  EXPECT_EQ(counter.calls, 1);
}

TEST(Background, ThatCannotBeStartedSaysSo) {
  const test::NoMoreThreads none;
  EXPECT_THROW(Background(true), std::system_error);
  Counter counter;
  Background(false).start<&Counter::count>(&counter);
  EXPECT_EQ(counter.calls, 1);
}

TEST(Background, StartingAllocatesNothing) {
  Counter counter;
  Background background(true);
  background.start<&Counter::count>(&counter);
  background.wait();
  const test::AllocationCount count;
  for (int i = 0; i < 10; ++i) background.start<&Counter::count>(&counter);
  background.wait();
  EXPECT_EQ(count.allocations(), 0);
}

}  // namespace
}  // namespace waymark
