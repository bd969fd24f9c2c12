#include "workbench/bags/split_bag.hpp"

#include <algorithm>
#include <charconv>
#include <system_error>
#include <utility>

#include <fmt/format.h>

namespace waymark::bag {
namespace {

namespace fs = std::filesystem;

// rosbag goes on with the next part at once.
constexpr Duration kApart = std::chrono::seconds(10);
constexpr std::string_view kDigits = "0123456789";

/// "drive_2024-05-01_12.bag" is number 12 of "drive_####-##-##": the date is that of the part.
struct PartName {
  std::string undated;
  std::string dated;
  int number = 0;
};

bool is_ros1_name(std::string_view name) {
  return (name.ends_with(".bag") && !name.ends_with(".orig.bag")) || name.ends_with(".bag.active");
}

std::optional<PartName> part_name(const fs::path& file) {
  std::string name = file.filename().string();
  if (!is_ros1_name(name)) return std::nullopt;
  name.resize(name.rfind(".bag"));
  const auto line = name.rfind('_');
  if (line == std::string::npos) return std::nullopt;
  PartName part;
  const char* const end = name.data() + name.size();
  const auto read = std::from_chars(name.data() + line + 1, end, part.number);
  if (read.ec != std::errc{} || read.ptr != end || part.number < 0) return std::nullopt;
  part.undated = part.dated = name.substr(0, line);
  for (char& c : part.undated)
    if (kDigits.find(c) != std::string_view::npos) c = '#';
  return part;
}

/// How many parts lie between two bags; empty: the second is no later part of the same recording.
std::optional<int> parts_between(const fs::path& earlier, const fs::path& later) {
  const auto a = part_name(earlier), b = part_name(later);
  if (!a || !b || a->undated != b->undated || a->number >= b->number) return std::nullopt;
  return b->number - a->number - 1;
}

/// Parts may lie apart in time if they have one name, or if others are missing between them.
bool may_lie_apart(const fs::path& earlier, const fs::path& later) {
  const auto between = parts_between(earlier, later);
  return between && (*between > 0 || part_name(earlier)->dated == part_name(later)->dated);
}

}  // namespace

std::vector<fs::path> ros1_bags_in(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code failed;
  for (const auto& entry : fs::directory_iterator(folder, failed))
    if (is_ros1_name(entry.path().filename().string())) files.push_back(entry.path());
  std::ranges::sort(files, {},
                    [](const fs::path& file) { return std::pair(file.string().size(), file.string()); });
  return files;
}

std::vector<fs::path> parts_from(const fs::path& first) {
  std::vector<fs::path> parts{first};
  const auto name = part_name(first);
  if (!name || name->number != 0) return parts;
  const fs::path folder = first.parent_path().empty() ? fs::path(".") : first.parent_path();
  for (const fs::path& file : ros1_bags_in(folder))
    if (parts_between(parts.back(), file) == 0) parts.push_back(file);
  return parts;
}

std::vector<std::string> missing_parts(const std::vector<PartSpan>& spans) {
  std::vector<std::string> lines;
  for (std::size_t i = 1; i < spans.size(); ++i)
    if (const int missing = parts_between(spans[i - 1].file, spans[i].file).value_or(0); missing > 0)
      lines.push_back(fmt::format("parts of the recording missing between {} and {}: {}",
                                  spans[i - 1].file.filename().string(), spans[i].file.filename().string(),
                                  missing));
  return lines;
}

std::optional<std::string> why_not_one(const std::vector<PartSpan>& spans) {
  for (std::size_t i = 1; i < spans.size(); ++i) {
    Stamp last{Duration::min()};
    for (std::size_t k = 0; k < i; ++k) last = std::max(last, spans[k].last);
    if (spans[i].first - last > kApart && !may_lie_apart(spans[i - 1].file, spans[i].file))
      return fmt::format("{} begins {:.0f} s after {} and those before it have ended",
                         spans[i].file.filename().string(), to_seconds(spans[i].first - last),
                         spans[i - 1].file.filename().string());
  }
  return std::nullopt;
}

}  // namespace waymark::bag
