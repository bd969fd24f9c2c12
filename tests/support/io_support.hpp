#pragma once

#include <unistd.h>

#include <atomic>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "workbench/logs/files.hpp"
#include "workbench/logs/source.hpp"

namespace waymark::test {

/// A new folder for one test, gone with it.
class TempFolder {
 public:
  TempFolder() {
    static std::atomic<int> count = 0;
    path_ = std::filesystem::temp_directory_path() /
            ("waymark_io_test_" + std::to_string(::getpid()) + "_" + std::to_string(count++));
    std::filesystem::create_directories(path_);
  }
  TempFolder(const TempFolder&) = delete;
  TempFolder& operator=(const TempFolder&) = delete;
  ~TempFolder() { std::filesystem::remove_all(path_); }

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

  std::filesystem::path write(std::string_view name, std::string_view content) const {
    auto file = path_ / name;
    std::filesystem::create_directories(file.parent_path());
    EXPECT_TRUE(write_file(file, content).ok());
    return file;
  }

 private:
  std::filesystem::path path_;
};

/// What a source delivers up to its end or to the first error.
struct Delivered {
  std::vector<Event> events;
  std::string error;
};

inline Delivered read_all(Source& source) {
  Delivered delivered;
  while (true) {
    auto event = source.next();
    if (!event) delivered.error = event.error().message;
    if (!event || !*event) return delivered;
    delivered.events.push_back(**std::move(event));
  }
}

/// The events whose content is a T.
template <class T>
std::vector<std::pair<Stamp, T>> only(const std::vector<Event>& events) {
  std::vector<std::pair<Stamp, T>> found;
  for (const auto& event : events)
    if (const T* content = std::get_if<T>(&event.content)) found.emplace_back(event.stamp, *content);
  return found;
}

inline std::size_t count_observations(const std::vector<Event>& events) {
  std::size_t count = 0;
  for (const auto& [stamp, observations] : only<Observations>(events)) count += observations.size();
  return count;
}

}  // namespace waymark::test
