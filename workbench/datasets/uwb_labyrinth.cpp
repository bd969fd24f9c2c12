#include "workbench/datasets/uwb_labyrinth.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "workbench/config/known_settings.hpp"
#include "workbench/logs/event_list.hpp"
#include "workbench/logs/files.hpp"
#include "workbench/logs/text_lines.hpp"

namespace waymark {
namespace {

namespace fs = std::filesystem;

constexpr const char* kInputFile = "Indoor_UWB_Input.txt";
constexpr const char* kTruthFile = "Indoor_UWB_GT.txt";

/// One line: what it measures, and its numbers after that.
struct Measured {
  std::string_view kind;
  std::vector<double> numbers;  ///< the first is the time, s
  Stamp stamp;
};

/// A kind of line and how many numbers it has.
struct LineLayout {
  std::string_view kind;
  std::size_t numbers;
  std::string_view meaning;
};

constexpr LineLayout kRange{"range2", 7, "time, range, variance, anchor x, anchor y, anchor id, SNR"};
constexpr LineLayout kWheels{"odom2diff", 8,
                             "time, left and right speed, sideways speed, track, 3 variances"};
constexpr LineLayout kPoint{"point2", 7, "time, x, y, 4 variances"};

Result<Measured> parse(const TextLines& lines, const std::vector<LineLayout>& layouts) {
  std::string_view rest = lines.line();
  Measured measured{.kind = take_word(rest), .numbers = {}, .stamp = {}};
  const auto layout = std::ranges::find(layouts, measured.kind, &LineLayout::kind);
  if (layout == layouts.end()) return lines.error(in_quotes(measured.kind) + " is not a known kind of line");
  const std::string_view time = take_word(rest);
  const auto stamp = parse_stamp(time);
  if (!stamp) return lines.error(in_quotes(time) + " is not a time in seconds");
  measured.stamp = *stamp;
  measured.numbers.push_back(to_seconds(*stamp));
  for (auto word = take_word(rest); !word.empty(); word = take_word(rest)) {
    const auto number = parse_number(word);
    if (!number || !std::isfinite(*number)) return lines.error(in_quotes(word) + " is not a number");
    measured.numbers.push_back(*number);
  }
  if (measured.numbers.size() != layout->numbers)
    return lines.error(fmt::format("expected {} numbers after {}: {}; found {}", layout->numbers,
                                   layout->kind, layout->meaning, measured.numbers.size()));
  return measured;
}

/// Reads line by line; the first error ends it.
template <class Use>
Result<void> for_each_line(const fs::path& file, const std::vector<LineLayout>& layouts, const Use& use) {
  auto lines = TextLines::open(file);
  if (!lines) return lines.error();
  while (lines->next()) {
    const auto measured = parse(*lines, layouts);
    if (!measured) return measured.error();
    if (auto used = use(*measured, *lines); !used) return used.error();
  }
  return {};
}

/// Sums up what the wheels rolled: a speed holds until the next one.
class Wheels {
 public:
  [[nodiscard]] WheelAngles advance(const Measured& speeds) {
    if (last_) {
      const double dt_s = to_seconds(speeds.stamp - last_->stamp);
      rolled_.left_rad += last_->numbers[1] * dt_s;
      rolled_.right_rad += last_->numbers[2] * dt_s;
    }
    last_ = speeds;
    return rolled_;
  }

 private:
  WheelAngles rolled_;
  std::optional<Measured> last_;
};

TrueLandmark anchor_of(const Measured& range) {
  const LandmarkId id{LandmarkId::Family::kMarker, static_cast<std::int32_t>(range.numbers[5])};
  return {id, range.numbers[3], range.numbers[4], 0.0};
}

Result<void> read_input(const fs::path& file, LogInfo& info, std::vector<Event>& events) {
  Wheels wheels;
  return for_each_line(
      file, {kRange, kWheels}, [&](const Measured& m, const TextLines& lines) -> Result<void> {
        if (m.kind == kWheels.kind) {
          events.emplace_back(m.stamp, wheels.advance(m));
          return {};
        }
        if (m.numbers[1] < 0.0) return lines.error("a range cannot be negative");
        if (std::abs(m.numbers[5]) > 1e6) return lines.error("is not the number of an anchor");
        const TrueLandmark anchor = anchor_of(m);
        if (std::ranges::find(info.landmarks, anchor.id, &TrueLandmark::id) == info.landmarks.end())
          info.landmarks.push_back(anchor);
        events.emplace_back(m.stamp, Observations{{anchor.id, Range{m.numbers[1]}, std::nullopt}});
        return {};
      });
}

Result<void> read_labyrinth_truth(const fs::path& file, std::vector<Event>& events) {
  if (!fs::exists(file)) return {};
  return for_each_line(file, {kPoint}, [&](const Measured& m, const TextLines&) -> Result<void> {
    events.emplace_back(m.stamp, Truth{m.numbers[1], m.numbers[2], std::nullopt});
    return {};
  });
}

}  // namespace

bool is_uwb_labyrinth(const fs::path& folder) { return fs::exists(folder / kInputFile); }

Result<std::unique_ptr<Source>> open_uwb_labyrinth(const fs::path& folder) {
  LogInfo info;
  info.name = base_name(folder);
  info.format = "UWB labyrinth";
  auto settings = known_settings("uwb-labyrinth");
  if (!settings) return settings.error();
  info.settings = *std::move(settings);
  std::vector<Event> events;
  if (auto done = read_input(folder / kInputFile, info, events); !done) return done.error();
  if (auto done = read_labyrinth_truth(folder / kTruthFile, events); !done) return done.error();
  return std::unique_ptr<Source>(std::make_unique<EventList>(std::move(info), std::move(events)));
}

}  // namespace waymark
