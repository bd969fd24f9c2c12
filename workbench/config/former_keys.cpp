#include "workbench/config/former_keys.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <map>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "workbench/config/flat_yaml.hpp"

namespace waymark {
namespace {

constexpr std::string_view kOfArticle = "set pixel.article=true for the methods of Vincke et al. 2012";

struct Renamed {
  std::string_view key;
  std::string_view now;
  std::string_view dropped_value;
};

struct Gone {
  std::string_view key;
  std::string_view why;
};

constexpr auto kRenamed = std::to_array<Renamed>({
    {"ekf.capacity", "map.capacity", "1000"},
    {"ekf.speed_scale_sigma", "motion.speed_scale_sigma", "0.1"},
    {"ekf.turn_bias_sigma_degps", "motion.turn_bias_sigma_degps", "0.1"},
    {"ekf.turn_scale_sigma", "motion.turn_scale_sigma", "0.1"},
    {"fastslam.capacity", "map.capacity", "1000"},
    {"fastslam.evidence_way_m", "fastslam.information_distance_m", ""},
    {"fastslam.move_above", "fastslam.enkf_above", ""},
    {"markers.mount_sigma_deg", "camera.jitter_deg", "0.05"},
    {"pixel.capacity", "map.capacity", "100"},
    {"pixel.most_candidates", "pixel.max_candidates", ""},
    {"pixel.vibration_deg", "camera.jitter_deg", "0.05"},
    {"pixel.wander_px", "pixel.landmark_noise_px", ""},
    {"sensor.lasting_bearing_sigma_deg", "sensor.bias_bearing_sigma_deg", ""},
    {"sensor.lasting_range_sigma_ratio", "sensor.bias_range_sigma_ratio", ""},
    {"sensor.lasting_way_m", "sensor.bias_distance_m", ""},
    {"smooth.least_leg_deg", "smooth.keyframe_turn_deg", ""},
    {"smooth.least_leg_m", "smooth.keyframe_distance_m", ""},
    {"smooth.speed_scale_sigma", "motion.speed_scale_sigma", "0.05"},
    {"smooth.turn_bias_sigma_degps", "motion.turn_bias_sigma_degps", "0.1"},
    {"smooth.turn_scale_sigma", "motion.turn_scale_sigma", "0.05"},
    {"tracker.most_candidates", "pixel.max_candidates", "8"},
});

constexpr auto kGone = std::to_array<Gone>({
    {"association.confirmed_log_odds", "always 6"},
    {"association.most_log_odds", "always 12"},
    {"association.most_pairings", "always 2000"},
    {"corners.arc", "always 12"},
    {"ekf.evict", "the least informative landmark is always removed from a full map"},
    {"ekf.region", "always 64"},
    {"ekf.update", kOfArticle},
    {"fastslam.init",
     "a landmark that was observed by range or bearing alone always starts as a whole ring or ray"},
    {"fastslam.kld_error", "the number of particles stays fastslam.particles"},
    {"fastslam.kld_least", "the number of particles stays fastslam.particles"},
    {"fastslam.resample_below", "always 0.5, or set fastslam.always_resample=true"},
    {"fastslam.temper_below", "always 0.1, or set fastslam.always_resample=true"},
    {"markers.max_tilt_deg", "always 75"},
    {"markers.own_thread", "always true"},
    {"motion.arc", kOfArticle},
    {"motion.standing_below_radps", "always 0.02"},
    {"pixel.depth_particles", "always 100"},
    {"pixel.depth_ratio", "always 0.3"},
    {"pixel.depth_spacing", kOfArticle},
    {"pixel.gate_probability", "always 0.9999"},
    {"pixel.init", kOfArticle},
    {"pixel.least_pictures", "always 8"},
    {"pixel.most_pictures", "always 15"},
    {"search.match", kOfArticle},
    {"search.max_windows", "always 2500"},
    {"search.probability", "always 0.9999"},
    {"smooth.most_iterations", "always 50"},
    {"tracker.cells_u", "always 4"},
    {"tracker.cells_v", "always 3"},
    {"tracker.distance_px", "always 20"},
    {"tracker.kernels", kOfArticle},
    {"tracker.most_new", "always 4"},
    {"tracker.most_observed", "always 30"},
    {"tracker.patch_px", "always 16"},
    {"tracker.subpixel", kOfArticle},
    {"tracker.warp", kOfArticle},
});

constexpr auto kFormerKeys = [] {
  std::array<FormerKey, kRenamed.size() + kGone.size()> all{};
  auto* next = all.begin();
  for (const Renamed& each : kRenamed) *next++ = {each.key, each.now, "", each.dropped_value};
  for (const Gone& each : kGone) *next++ = {each.key, "", each.why, ""};
  return all;
}();

std::string_view section_of(std::string_view key) { return key.substr(0, key.find('.') + 1); }
std::string_view last_part(std::string_view key) { return key.substr(key.rfind('.') + 1); }

std::vector<std::string> split_lines(std::string_view text) {
  std::vector<std::string> lines;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size() - 1) + 1;
    lines.emplace_back(text.substr(0, text[end - 1] == '\n' ? end - 1 : end));
    text.remove_prefix(end);
  }
  return lines;
}

/// One file while its former keys are replaced.
class Migration {
 public:
  Migration(const std::string& yaml, const std::string& name) : name_(name), lines_(split_lines(yaml)) {}

  Result<void> replace(const FlatYamlEntry& entry, const FormerKey& former) {
    std::string& line = lines_[static_cast<std::size_t>(entry.line) - 1];
    const std::size_t at = line.find_first_not_of(' ');
    const std::size_t colon = line.find(':');
    const std::string_view written = std::string_view(line).substr(at, colon - at);
    if (colon == std::string::npos || (written != former.key && written != last_part(former.key)))
      return Error{fmt::format("{}:{}: {}; this line holds more than that key, so change it by hand", name_,
                               entry.line, what_became_of(former))};
    if (former.now.empty() || entry.value == former.dropped_value)
      line = fmt::format("{}# {}  # {}", line.substr(0, at), line.substr(at), what_became_of(former));
    else if (auto done = rename(entry, former, line, written.size()); !done)
      return done;
    return {};
  }

  [[nodiscard]] std::string text() const {
    std::string all;
    for (const auto& line : lines_) all += line + "\n";
    for (const auto& [key, value] : moved_) all += fmt::format("{}: {}\n", key, value);
    return all;
  }

 private:
  Result<void> rename(const FlatYamlEntry& entry, const FormerKey& former, std::string& line,
                      std::size_t length) {
    const std::size_t at = line.find_first_not_of(' ');
    if (section_of(former.key) == section_of(former.now)) {
      line.replace(at, length, length == former.key.size() ? former.now : last_part(former.now));
      return {};
    }
    const auto [known, is_new] = moved_.emplace(former.now, entry.value);
    if (!is_new && known->second != entry.value)
      return Error{fmt::format("{}:{}: {}, which this file sets twice, to different values; keep one of them",
                               name_, entry.line, what_became_of(former))};
    line = fmt::format("{}# {}  # {}", line.substr(0, at), line.substr(at), what_became_of(former));
    return {};
  }

  const std::string& name_;
  std::vector<std::string> lines_;
  std::map<std::string, std::string> moved_;  ///< to another section, by their new keys
};

}  // namespace

std::span<const FormerKey> former_keys() { return kFormerKeys; }

const FormerKey* find_former_key(std::string_view key) {
  const auto* const found = std::ranges::find(kFormerKeys, key, &FormerKey::key);
  return found == kFormerKeys.end() ? nullptr : found;
}

std::string what_became_of(const FormerKey& former) {
  return former.now.empty() ? fmt::format("{} was removed: {}", former.key, former.why)
                            : fmt::format("{} is now {}", former.key, former.now);
}

Result<std::string> migrate_config(const std::string& yaml, const std::string& name) {
  const auto entries = flatten_yaml(yaml, name);
  if (!entries) return entries.error();
  Migration migration(yaml, name);
  for (const FlatYamlEntry& entry : *entries)
    if (const FormerKey* former = find_former_key(entry.key))
      if (auto done = migration.replace(entry, *former); !done) return done.error();
  return migration.text();
}

}  // namespace waymark
