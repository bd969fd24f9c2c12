#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "waymark/core/stamp.hpp"

namespace waymark::bag {

/// The ROS 1 bags of a folder, by name: part_10 is behind part_9. What `rosbag reindex` keeps of the bag
/// before (.orig.bag) is none of them; what a recorder that was stopped left (.bag.active) is.
[[nodiscard]] std::vector<std::filesystem::path> ros1_bags_in(const std::filesystem::path& folder);

/// The parts of the recording whose first one, as `rosbag record --split` names it ("drive_0.bag", or
/// "drive_2024-05-01-10-00-00_0.bag"), is given: that file and those beside it that go on counting. Only the
/// digits of the names may differ. Any other file is alone.
[[nodiscard]] std::vector<std::filesystem::path> parts_from(const std::filesystem::path& first);

/// A bag of several that may be one recording.
struct PartSpan {
  std::filesystem::path file;
  Stamp first;  ///< when its first message was recorded
  Stamp last;
};

/// What `spans`, in the order of time, leave out of a recording: parts whose numbers are missing. One line
/// each.
[[nodiscard]] std::vector<std::string> missing_parts(const std::vector<PartSpan>& spans);

/// Which bag begins more than 10 s after those before it and is no part that goes on counting; nothing where
/// `spans`, in the order of time, can be one recording.
[[nodiscard]] std::optional<std::string> why_not_one(const std::vector<PartSpan>& spans);

}  // namespace waymark::bag
