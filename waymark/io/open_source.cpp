#include "waymark/io/open_source.hpp"

#include <algorithm>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "waymark/io/log_folder.hpp"

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

Error not_a_log(const fs::path& folder) {
  return {fmt::format(
      "{} is a directory but no log: expected log.yaml with wheels.csv, velocity.csv, steering.csv or "
      "odometry.csv, or MRCLAM's Barcodes.dat with RobotN_Odometry.dat; found {}",
      folder.string(), some_content(folder))};
}

Error not_a_folder(const fs::path& file) {
  const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
  if (is_log_folder(folder) || is_mrclam(folder))
    return {fmt::format("{} is one file of a log; give its folder, {}", file.string(), folder.string())};
  return {fmt::format("{} is no log: expected a log folder or an MRCLAM directory", file.string())};
}

}  // namespace

void describe(Schema& schema, InputOptions& options) {
  schema.integer("input.robot", options.mrclam.robot, {1, 99},
                 "which robot, where a recording holds several");
  schema.boolean("input.fix_known_errors", options.mrclam.fix_known_errors,
                 "put right what is known to be wrong in a published recording");
}

Result<std::unique_ptr<Source>> open_source(const fs::path& path, const InputOptions& options) {
  std::error_code failed;
  const auto status = fs::status(path, failed);
  if (status.type() == fs::file_type::not_found) return Error{"no such file or directory: " + path.string()};
  if (failed) return Error{"cannot read " + path.string() + ": " + failed.message()};
  if (!fs::is_directory(status)) return not_a_folder(path);
  if (is_log_folder(path)) return open_log_folder(path);
  if (is_mrclam(path)) return open_mrclam(path, options.mrclam);
  return not_a_log(path);
}

}  // namespace waymark
