#include "workbench/run/open_source.hpp"

#include <algorithm>
#include <string>
#include <system_error>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "workbench/bags/open_bag.hpp"
#include "workbench/run/input_formats.hpp"

namespace waymark {
namespace {

namespace fs = std::filesystem;

/// Names of some of the files in a folder, "nothing" if there are none.
std::string some_content(const fs::path& folder) {
  constexpr std::size_t kShown = 5;
  std::vector<std::string> names;
  std::error_code failed;
  for (const auto& entry : fs::directory_iterator(folder, failed))
    names.push_back(entry.path().filename().string());
  if (names.empty()) return "nothing";
  std::ranges::sort(names);
  const std::size_t more = names.size() > kShown ? names.size() - kShown : 0;
  names.resize(names.size() - more);
  return fmt::format("{}{}", fmt::join(names, ", "), more > 0 ? fmt::format(" and {} more", more) : "");
}

/// What folders are recognised by.
std::vector<std::string> expected_in_folders() {
  std::vector<std::string> expected;
  for (const InputFormat& format : input_formats())
    if (format.can_be(InputFormat::Place::kFolder)) expected.push_back(format.expects);
  return expected;
}

Error no_log_in(const fs::path& folder) {
  return {fmt::format("{} is a directory, but not a log: expected {}; found {}", folder.string(),
                      fmt::join(expected_in_folders(), "; or "), some_content(folder))};
}

/// Does the folder hold a log of several files, none of which can be opened alone?
bool is_log_of_several_files(const fs::path& folder) {
  return std::ranges::any_of(input_formats(), [&folder](const InputFormat& format) {
    return format.place == InputFormat::Place::kFolder && format.recognises(folder);
  });
}

std::vector<std::string> format_names() {
  std::vector<std::string> names;
  for (const InputFormat& format : input_formats()) names.push_back(format.name);
  return names;
}

Error no_log_file(const fs::path& file) {
  const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
  if (is_log_of_several_files(folder))
    return {fmt::format("{} is only one file of a log; give its folder, {}", file.string(), folder.string())};
  std::error_code ignored;
  if (fs::is_regular_file(file, ignored) && fs::is_empty(file, ignored))
    return {file.string() + ": the file is empty; was its recording cut off?"};
  return {fmt::format("{} is not a log: expected {}", file.string(), fmt::join(format_names(), "; or "))};
}

const InputFormat* format_of(const fs::path& path, InputFormat::Place place) {
  const auto found = std::ranges::find_if(input_formats(), [&](const InputFormat& format) {
    return format.can_be(place) && format.recognises(path);
  });
  return found == input_formats().end() ? nullptr : &*found;
}

InputFormat::Place place_of(const fs::path& path) {
  std::error_code ignored;
  return fs::is_directory(path, ignored) ? InputFormat::Place::kFolder : InputFormat::Place::kFile;
}

}  // namespace

bool is_log(const fs::path& path) { return format_of(path, place_of(path)) != nullptr; }

Result<std::unique_ptr<Source>> open_source(const fs::path& path, const InputOptions& options) {
  std::error_code failed;
  const auto status = fs::status(path, failed);
  if (status.type() == fs::file_type::not_found) return Error{"no such file or directory: " + path.string()};
  if (failed) return Error{"cannot read " + path.string() + ": " + failed.message()};
  if (!options.bag.more_bags.empty() && !bag::is_bag(path) && !bag::is_folder_of_bags(path))
    return Error{path.string() + ": of several inputs each must be a ROS bag, all of one drive"};
  const auto place = place_of(path);
  if (const InputFormat* format = format_of(path, place)) return format->open(path, options);
  return place == InputFormat::Place::kFolder ? no_log_in(path) : no_log_file(path);
}

}  // namespace waymark
