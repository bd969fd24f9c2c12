#include "workbench/bags/open_bag.hpp"

#include <algorithm>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include "workbench/bags/byte_stream.hpp"
#include "workbench/bags/joined_bag.hpp"
#include "workbench/bags/mcap_format.hpp"
#include "workbench/bags/ros1_format.hpp"
#include "workbench/bags/sqlite_bag.hpp"
#include "workbench/config/load_yaml.hpp"
#include "workbench/logs/files.hpp"

namespace waymark::bag {
namespace {

namespace fs = std::filesystem;

constexpr const char* kMetadata = "metadata.yaml";
constexpr const char* kMetadataRoot = "rosbag2_bagfile_information";

std::string first_bytes(const fs::path& path) {
  std::string bytes(16, '\0');
  const auto file = InputFile::open(path);
  const auto count = file ? (*file)->read(0, bytes) : Result<std::size_t>(0);
  bytes.resize(count ? *count : 0);
  return bytes;
}

Result<std::unique_ptr<Reader>> open_bag_file(const fs::path& path) {
  if (const auto file = InputFile::open(path); !file) return file.error();
  const std::string magic = first_bytes(path);
  if (is_ros1_bag(magic)) return open_ros1_bag(path);
  if (is_mcap(magic)) return open_mcap(path);
  if (is_sqlite(magic)) return open_sqlite_bag(path);
  if (path.extension() == ".zstd")
    return Error{
        fmt::format("{}: compressed as a whole; unpack it by `zstd -d {}` and give the resulting file",
                    path.string(), path.string())};
  return Error{fmt::format("{}: {}; expected a ROS 1 bag, an MCAP file or the .db3 file of a ROS 2 bag",
                           path.string(), magic.empty() ? "is empty" : "is not a bag")};
}

/// What a metadata.yaml says about the files beside it.
struct Metadata {
  std::vector<fs::path> files;
  bool packed_messages = false;
};

/// The first versions of ROS 2 named files from outside of the folder.
fs::path place_of(const fs::path& named, const fs::path& folder) {
  std::error_code ignored;
  return fs::exists(folder / named, ignored) ? folder / named : folder / named.filename();
}

Metadata read_metadata(const YAML::Node& root, const fs::path& folder) {
  Metadata metadata;
  const YAML::Node bag = root[kMetadataRoot];
  std::set<std::string> names;  // a file that is named twice is one file
  for (const YAML::Node& node : bag["relative_file_paths"]) {
    const fs::path named = node.as<std::string>();
    if (names.insert(named.string()).second) metadata.files.push_back(place_of(named, folder));
  }
  const auto mode = bag["compression_mode"].as<std::string>("");
  metadata.packed_messages = mode == "MESSAGE" || mode == "message";
  return metadata;
}

/// The .db3 and .mcap files of a folder that has lost its metadata.yaml; name_10 is behind name_9.
std::vector<fs::path> bag_files(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code failed;
  for (const auto& entry : fs::directory_iterator(folder, failed))
    if (entry.path().extension() == ".db3" || entry.path().extension() == ".mcap")
      files.push_back(entry.path());
  std::ranges::sort(files, {},
                    [](const fs::path& file) { return std::pair(file.string().size(), file.string()); });
  return files;
}

Result<Metadata> look_into(const fs::path& folder) {
  const fs::path file = folder / kMetadata;
  if (!fs::exists(file)) return Metadata{bag_files(folder)};
  const auto text = read_file(file);
  if (!text) return text.error();
  const auto root = load_yaml(*text, file.string());
  if (!root) return root.error();
  try {
    return read_metadata(*root, folder);
  } catch (const YAML::Exception& problem) {
    return Error{fmt::format("{}:{}: {}", file.string(), problem.mark.line + 1, problem.msg)};
  }
}

Result<std::unique_ptr<Reader>> open_bag_folder(const fs::path& folder) {
  const auto metadata = look_into(folder);
  if (!metadata) return metadata.error();
  std::vector<std::unique_ptr<Reader>> parts;
  std::vector<std::string> notes;
  for (const fs::path& file : metadata->files) {
    auto part = open_bag_file(file);
    if (part) {
      parts.push_back(*std::move(part));
    } else {
      notes.push_back(part.error().message);
    }
  }
  if (parts.empty())
    return Error{notes.empty()
                     ? fmt::format("{}: {} lists no files in relative_file_paths", folder.string(), kMetadata)
                     : notes[0]};
  return join_bags(std::move(parts), metadata->packed_messages, std::move(notes));
}

bool is_bag_folder(const fs::path& folder) {
  if (!bag_files(folder).empty()) return true;
  const auto text = read_file(folder / kMetadata);
  return text && text->find(kMetadataRoot) != std::string::npos;
}

}  // namespace

bool is_bag(const fs::path& path) {
  if (fs::is_directory(path)) return is_bag_folder(path);
  const std::string magic = first_bytes(path);
  return is_ros1_bag(magic) || is_mcap(magic) || is_sqlite(magic);
}

Result<std::unique_ptr<Reader>> open_bag(const fs::path& path) {
  return fs::is_directory(path) ? open_bag_folder(path) : open_bag_file(path);
}

}  // namespace waymark::bag
