#include "workbench/bags/open_bag.hpp"

#include <algorithm>
#include <iterator>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include "workbench/bags/byte_stream.hpp"
#include "workbench/bags/joined_bag.hpp"
#include "workbench/bags/mcap_format.hpp"
#include "workbench/bags/ros1_format.hpp"
#include "workbench/bags/split_bag.hpp"
#include "workbench/bags/sqlite_bag.hpp"
#include "workbench/bags/unpacked_file.hpp"
#include "workbench/config/load_yaml.hpp"
#include "workbench/logs/files.hpp"

namespace waymark::bag {
namespace {

namespace fs = std::filesystem;

constexpr const char* kMetadata = "metadata.yaml";
constexpr const char* kMetadataRoot = "rosbag2_bagfile_information";
constexpr const char* kPacked = ".zstd";

std::string first_bytes(const fs::path& path) {
  std::string bytes(16, '\0');
  const auto file = InputFile::open(path);
  const auto count = file ? (*file)->read(0, bytes) : Result<std::size_t>(0);
  bytes.resize(count ? *count : 0);
  return bytes;
}

Result<std::unique_ptr<Reader>> open_bag_file(const fs::path& path);

/// What is open stays readable when its file is gone.
Result<std::unique_ptr<Reader>> open_packed_bag(const fs::path& path) {
  const auto file = UnpackedFile::unpack(path);
  if (!file) return file.error();
  if (is_zstd(first_bytes((*file)->path()))) return Error{path.string() + ": is packed by zstd twice"};
  return open_bag_file((*file)->path());
}

Result<std::unique_ptr<Reader>> open_bag_file(const fs::path& path) {
  if (const auto file = InputFile::open(path); !file) return file.error();
  const std::string magic = first_bytes(path);
  if (is_ros1_bag(magic)) return open_ros1_bag(path);
  if (is_mcap(magic)) return open_mcap(path);
  if (is_sqlite(magic)) return open_sqlite_bag(path);
  if (is_zstd(magic)) return open_packed_bag(path);
  return Error{fmt::format("{}: {}; expected a ROS 1 bag, an MCAP file or the .db3 file of a ROS 2 bag",
                           path.string(), magic.empty() ? "is empty" : "is not a bag")};
}

/// Where a file lies that a metadata.yaml names. The first versions of ROS 2 named files from outside of the
/// folder; and it may have been packed or unpacked since.
fs::path place_of(const fs::path& named, const fs::path& folder) {
  std::error_code ignored;
  for (const fs::path& name : {named, named.filename()}) {
    fs::path file = folder / name;
    if (fs::exists(file, ignored)) return file;
    if (fs::exists(file.string() + kPacked, ignored)) return file.string() + kPacked;
    if (file.extension() == kPacked && fs::exists(folder / name.parent_path() / name.stem(), ignored))
      return folder / name.parent_path() / name.stem();
  }
  return folder / named.filename();
}

std::vector<fs::path> named_files(const YAML::Node& root, const fs::path& folder) {
  std::vector<fs::path> files;
  std::set<std::string> names;  // a file that is named twice is one file
  for (const YAML::Node& node : root[kMetadataRoot]["relative_file_paths"]) {
    const fs::path named = node.as<std::string>();
    if (names.insert(named.string()).second) files.push_back(place_of(named, folder));
  }
  return files;
}

/// A .db3 or .mcap file, packed or not; packed, and unpacked beside that, it is one.
bool is_ros2_file(const fs::path& file) {
  if (file.extension() == ".db3" || file.extension() == ".mcap") return true;
  const fs::path unpacked = fs::path(file).replace_extension();
  std::error_code ignored;
  return file.extension() == kPacked && is_ros2_file(unpacked) && !fs::exists(unpacked, ignored);
}

/// The .db3 and .mcap files of a folder that has lost its metadata.yaml; name_10 is behind name_9.
std::vector<fs::path> ros2_files_in(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code failed;
  for (const auto& entry : fs::directory_iterator(folder, failed))
    if (is_ros2_file(entry.path())) files.push_back(entry.path());
  std::ranges::sort(files, {},
                    [](const fs::path& file) { return std::pair(file.string().size(), file.string()); });
  return files;
}

Result<std::vector<fs::path>> files_of(const fs::path& folder) {
  const fs::path file = folder / kMetadata;
  if (!fs::exists(file)) return ros2_files_in(folder);
  const auto text = read_file(file);
  if (!text) return text.error();
  const auto root = load_yaml(*text, file.string());
  if (!root) return root.error();
  try {
    return named_files(*root, folder);
  } catch (const YAML::Exception& problem) {
    return Error{fmt::format("{}:{}: {}", file.string(), problem.mark.line + 1, problem.msg)};
  }
}

/// Bags that can be opened, and why others can not.
struct Opened {
  struct Part {
    fs::path file;
    std::unique_ptr<Reader> bag;
  };
  std::vector<Part> parts;
  std::vector<std::string> notes;
};

Opened open_files(const std::vector<fs::path>& files) {
  Opened opened;
  for (const fs::path& file : files) {
    std::error_code ignored;
    const bool is_missing = fs::symlink_status(file, ignored).type() == fs::file_type::not_found;
    auto bag = is_missing ? Error{fmt::format("{} is missing: what it held is not used", file.string())}
                          : open_bag_file(file);
    if (bag)
      opened.parts.push_back({file, *std::move(bag)});
    else
      opened.notes.push_back(bag.error().message);
  }
  return opened;
}

std::unique_ptr<Reader> join(Opened opened) {
  std::vector<std::unique_ptr<Reader>> bags;
  for (auto& part : opened.parts) bags.push_back(std::move(part.bag));
  return join_bags(std::move(bags), std::move(opened.notes));
}

Result<std::unique_ptr<Reader>> open_ros2_folder(const fs::path& folder) {
  const auto files = files_of(folder);
  if (!files) return files.error();
  auto opened = open_files(*files);
  if (!opened.parts.empty()) return join(std::move(opened));
  if (!opened.notes.empty()) return Error{folder.string() + ": " + opened.notes[0]};
  return Error{fmt::format("{}: {} lists no files in relative_file_paths", folder.string(), kMetadata)};
}

/// When the bags that hold anything were recorded, in the order of time.
std::vector<PartSpan> spans_of(const Opened& opened) {
  std::vector<PartSpan> spans;
  for (const auto& [file, bag] : opened.parts)
    if (const Summary& summary = bag->summary(); summary.first)
      spans.push_back({file, *summary.first, *summary.last});
  std::ranges::stable_sort(spans, {}, &PartSpan::first);
  return spans;
}

/// Bags that were recorded one after the other, or at the same time.
Result<std::unique_ptr<Reader>> join_in_time(Opened opened) {
  if (opened.parts.empty()) return Error{opened.notes.front()};
  std::ranges::stable_sort(opened.parts, {},
                           [](const Opened::Part& part) { return part.bag->summary().first; });
  std::ranges::move(missing_parts(spans_of(opened)), std::back_inserter(opened.notes));
  return join(std::move(opened));
}

Result<std::unique_ptr<Reader>> open_ros1_folder(const fs::path& folder) {
  auto opened = open_files(ros1_bags_in(folder));
  if (const auto apart = why_not_one(spans_of(opened)))
    return Error{fmt::format("{}: its bags are not of one recording ({}); give one of them at a time",
                             folder.string(), *apart)};
  return join_in_time(std::move(opened));
}

bool is_ros2_folder(const fs::path& folder) {
  if (!ros2_files_in(folder).empty()) return true;
  const auto text = read_file(folder / kMetadata);
  return text && text->find(kMetadataRoot) != std::string::npos;
}

/// All parts of the recording whose first one is the file; null: there are no others.
std::unique_ptr<Reader> open_parts(const fs::path& first) {
  const auto files = parts_from(first);
  if (files.size() == 1) return nullptr;
  auto opened = open_files(files);
  if (opened.parts.size() == 1 || why_not_one(spans_of(opened))) return nullptr;
  opened.notes.push_back(fmt::format("{} is the first of {} parts of a recording: all are used, up to {}",
                                     first.filename().string(), opened.parts.size(),
                                     opened.parts.back().file.filename().string()));
  return join(std::move(opened));
}

/// The file; where it is the first of several parts, all of them.
Result<std::unique_ptr<Reader>> open_with_parts(const fs::path& path) {
  if (auto parts = open_parts(path)) return parts;
  auto bag = open_bag_file(path);
  if (!bag) return bag.error();
  std::vector<std::unique_ptr<Reader>> alone;
  alone.push_back(*std::move(bag));
  return join_bags(std::move(alone), {});
}

}  // namespace

bool is_bag(const fs::path& path) {
  if (fs::is_directory(path)) return is_ros2_folder(path);
  const std::string magic = first_bytes(path);
  return is_ros1_bag(magic) || is_mcap(magic) || is_sqlite(magic) || is_zstd(magic);
}

bool is_folder_of_bags(const fs::path& folder) { return !ros1_bags_in(folder).empty(); }

Result<std::unique_ptr<Reader>> open_bag(const fs::path& path) {
  if (!fs::is_directory(path)) return open_with_parts(path);
  return is_ros2_folder(path) ? open_ros2_folder(path) : open_ros1_folder(path);
}

Result<std::unique_ptr<Reader>> open_bags(const std::vector<fs::path>& paths) {
  if (paths.size() == 1) return open_bag(paths[0]);
  Opened opened;
  for (const fs::path& path : paths) {
    auto bag = fs::is_directory(path) ? open_bag(path) : open_bag_file(path);
    if (!bag) return bag.error();
    opened.parts.push_back({path, *std::move(bag)});
  }
  return join_in_time(std::move(opened));
}

}  // namespace waymark::bag
