#include "workbench/datasets/mrclam.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "workbench/config/known_settings.hpp"
#include "workbench/datasets/rounded_stamps.hpp"
#include "workbench/logs/files.hpp"
#include "workbench/logs/merged_log.hpp"
#include "workbench/logs/text_lines.hpp"

namespace waymark {
namespace {

namespace fs = std::filesystem;

constexpr auto kBlank = TableLayout::Separator::kBlank;
constexpr int kLastRobotSubject = 5;

using Subjects = std::map<int, int>;  // by barcode

fs::path robot_file(const fs::path& folder, int robot, std::string_view what) {
  return folder / fmt::format("Robot{}_{}", robot, what);
}

/// The numbers of the robots whose odometry is here.
std::set<int> robots_in(const fs::path& folder) {
  std::set<int> robots;
  std::error_code failed;
  for (const auto& entry : fs::directory_iterator(folder, failed)) {
    const std::string name = entry.path().filename().string();
    const std::string_view number = std::string_view(name).substr(0, name.find('_'));
    if (!name.starts_with("Robot") || !name.ends_with("_Odometry.dat")) continue;
    if (const auto robot = parse_integer(number.substr(5))) robots.insert(*robot);
  }
  return robots;
}

LandmarkId landmark_id(int subject) { return {LandmarkId::Family::kBarcode, subject}; }

Result<Subjects> read_barcodes(const fs::path& file) {
  auto table = TextTable::open(file, {"subject,barcode", kBlank, ""});
  if (!table) return table.error();
  Subjects subjects;
  while (table->next()) {
    const int subject = table->integer(0);
    const auto [known, is_new] = subjects.emplace(table->integer(1), subject);
    if (!is_new)
      table->fail(fmt::format("barcode {} already belongs to subject {}", known->first, known->second));
  }
  if (table->error()) return *table->error();
  return subjects;
}

Result<std::vector<TrueLandmark>> read_landmarks(const fs::path& file) {
  std::vector<TrueLandmark> landmarks;
  if (!fs::exists(file)) return landmarks;
  auto table = TextTable::open(file, {"subject,x_m,y_m,x_sigma_m,y_sigma_m", kBlank, ""});
  if (!table) return table.error();
  while (table->next())
    landmarks.push_back({landmark_id(table->integer(0)), table->number(1), table->number(2), 0.0});
  if (table->error()) return *table->error();
  return landmarks;
}

/// Exchanges landmarks 11 and 17 where they stand as dataset 1 has them. False: this is another dataset.
bool fix_dataset_1(std::vector<TrueLandmark>& landmarks) {
  const auto find_at = [&](int subject, Eigen::Vector2d published) {
    return std::ranges::find_if(landmarks, [&](const TrueLandmark& l) {
      return l.id.number == subject && (Eigen::Vector2d(l.x_m, l.y_m) - published).norm() < 1e-3;
    });
  };
  const auto a = find_at(11, {3.15072, 2.38295});
  const auto b = find_at(17, {0.03596, -2.84397});
  if (a == landmarks.end() || b == landmarks.end()) return false;
  std::swap(a->id, b->id);
  return true;
}

std::optional<EventContent> read_velocity(TextTable& row, Tally&) {
  return Velocity{row.number(1), row.number(2)};
}

std::optional<EventContent> read_truth(TextTable& row, Tally&) {
  return Truth{row.number(1), row.number(2), row.number(3)};
}

EventStream::ReadRow read_observation(Subjects subjects) {
  return [subjects = std::move(subjects)](TextTable& row, Tally& tally) -> std::optional<EventContent> {
    const int barcode = row.integer(1);
    const RangeBearing value{row.number(2), row.number(3)};
    if (value.range_m < 0.0) row.fail(fmt::format("range {} m; a range cannot be negative", value.range_m));
    const auto subject = subjects.find(barcode);
    if (subject == subjects.end()) {
      tally.count(fmt::format("observations of barcode {} skipped, which is in no table", barcode));
      return std::nullopt;
    }
    if (subject->second <= kLastRobotSubject) {
      tally.count("observations skipped of other robots");
      return std::nullopt;
    }
    return Observations{{landmark_id(subject->second), value, std::nullopt}};
  };
}

Result<void> add_stream(Result<TextLines> lines, std::string columns, EventStream::ReadRow read_row,
                        std::vector<EventStream>& streams) {
  if (!lines) return lines.error();
  auto table = TextTable::from(*std::move(lines), {std::move(columns), kBlank, ""});
  if (!table) return table.error();
  streams.emplace_back(*std::move(table), std::move(read_row), EventStream::BackInTime::kSkip);
  return {};
}

fs::path published_truth(const fs::path& folder, int robot) {
  return robot_file(folder, robot, "Groundtruth.dat");
}

fs::path rounded_truth(const fs::path& folder, int robot) {
  return robot_file(folder, robot, "Groundtruth_rounded.csv");
}

/// Is the path here only with its stamps rounded to whole seconds?
bool is_truth_rounded(const fs::path& folder, int robot) {
  return !fs::exists(published_truth(folder, robot)) && fs::exists(rounded_truth(folder, robot));
}

Result<TextLines> truth_lines(const fs::path& folder, int robot) {
  if (!is_truth_rounded(folder, robot)) return TextLines::open(published_truth(folder, robot));
  auto lines = TextLines::open(rounded_truth(folder, robot));
  if (!lines) return lines;
  return spread_rounded_stamps(*std::move(lines));
}

Result<void> add_truth(const fs::path& folder, int robot, std::vector<EventStream>& streams) {
  if (!fs::exists(published_truth(folder, robot)) && !is_truth_rounded(folder, robot)) return {};
  return add_stream(truth_lines(folder, robot), "stamp_s,x_m,y_m,theta_rad", read_truth, streams);
}

Result<std::vector<EventStream>> open_streams(const fs::path& folder, int robot) {
  auto subjects = read_barcodes(folder / "Barcodes.dat");
  if (!subjects) return subjects.error();
  std::vector<EventStream> streams;
  if (auto done = add_stream(TextLines::open(robot_file(folder, robot, "Odometry.dat")),
                             "stamp_s,v_mps,w_radps", read_velocity, streams);
      !done)
    return done.error();
  if (auto done = add_truth(folder, robot, streams); !done) return done.error();
  if (auto done =
          add_stream(TextLines::open(robot_file(folder, robot, "Measurement.dat")),
                     "stamp_s,barcode,range_m,bearing_rad", read_observation(*std::move(subjects)), streams);
      !done)
    return done.error();
  return streams;
}

Result<LogInfo> read_info(const fs::path& folder, int robot) {
  LogInfo info;
  info.name = fmt::format("{} robot {}", base_name(folder), robot);
  info.format = "MRCLAM";
  auto settings = known_settings("mrclam");
  if (!settings) return settings.error();
  info.settings = *std::move(settings);
  auto landmarks = read_landmarks(folder / "Landmark_Groundtruth.dat");
  if (!landmarks) return landmarks.error();
  info.landmarks = *std::move(landmarks);
  return info;
}

/// Puts right what is known to be wrong; a note for each.
std::vector<std::string> put_right(const fs::path& folder, const MrclamOptions& options, LogInfo& info) {
  std::vector<std::string> notes;
  if (options.fix_known_errors && fix_dataset_1(info.landmarks))
    notes.emplace_back(
        "landmarks 11 and 17, which are published exchanged in dataset 1, were corrected "
        "(input.fix_known_errors)");
  if (is_truth_rounded(folder, options.robot))
    notes.push_back(base_name(rounded_truth(folder, options.robot)) +
                    ": stamps are rounded to whole seconds; the rows of a second were spread evenly over it, "
                    "and the first and last second left out");
  return notes;
}

}  // namespace

bool is_mrclam(const fs::path& folder) {
  return fs::exists(folder / "Barcodes.dat") && !robots_in(folder).empty();
}

Result<std::unique_ptr<Source>> open_mrclam(const fs::path& folder, const MrclamOptions& options) {
  if (const auto robots = robots_in(folder); !robots.contains(options.robot))
    return Error{fmt::format("{}: no robot {}; input.robot can be {}", folder.string(), options.robot,
                             fmt::join(robots, ", "))};
  auto info = read_info(folder, options.robot);
  if (!info) return info.error();
  auto streams = open_streams(folder, options.robot);
  if (!streams) return streams.error();

  auto notes = put_right(folder, options, *info);
  return std::unique_ptr<Source>(
      std::make_unique<MergedLog>(*std::move(info), *std::move(streams), std::move(notes)));
}

}  // namespace waymark
