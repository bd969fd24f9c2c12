#pragma once

#include <cstdlib>
#include <filesystem>
#include <string_view>

#include <gtest/gtest.h>

namespace waymark::test {

/// Where recordings lie: the environment variable WAYMARK_DATA_DIR, or what the build was configured with.
inline std::filesystem::path data_dir() {
  const char* from_environment = std::getenv("WAYMARK_DATA_DIR");
  return from_environment != nullptr ? from_environment : WAYMARK_DATA_DIR;
}

/// A recording (or one file of it) below `data_dir()`.
inline std::filesystem::path data_path(std::string_view name) { return data_dir() / name; }

}  // namespace waymark::test

/// Skips the running test, by name, where a recording is not on this machine.
#define WAYMARK_REQUIRE_DATA(name)                                  \
  if (!std::filesystem::exists(waymark::test::data_path(name)))     \
  GTEST_SKIP() << "no recording " << waymark::test::data_path(name) \
               << "; set WAYMARK_DATA_DIR to where it lies"
