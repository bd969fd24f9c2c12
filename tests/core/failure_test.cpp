#include "waymark/core/failure.hpp"

#include <new>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

namespace waymark {
namespace {

TEST(Failure, KeepsWhatAnExceptionSays) {
  const Error error = failure(std::runtime_error("the disk is gone"));
  EXPECT_EQ(error.message, "the disk is gone");
  EXPECT_EQ(error.kind, Error::Kind::kFailed);
}

TEST(Failure, PutsMissingMemoryIntoWords) {
  EXPECT_EQ(failure(std::bad_alloc()).message, "out of memory");
  try {
    std::vector<double>().reserve(std::vector<double>().max_size() + 1);
    FAIL() << "so much memory is nowhere";
  } catch (const std::exception& problem) {
    EXPECT_EQ(failure(problem).message, "out of memory");
  }
}

}  // namespace
}  // namespace waymark
