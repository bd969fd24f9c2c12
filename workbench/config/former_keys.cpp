#include "workbench/config/former_keys.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <functional>
#include <map>
#include <vector>

#include <fmt/format.h>

#include "workbench/config/flat_yaml.hpp"
#include "workbench/config/key_parts.hpp"

namespace waymark {
namespace {

constexpr std::string_view kOfArticle = "set pixel.article=true for the methods of Vincke et al. 2012";

constexpr auto kFormerKeys = std::to_array<FormerKey>({
    {.key = "association.confirmed_log_odds", .why = "always 6"},
    {.key = "association.most_log_odds", .why = "always 12"},
    {.key = "association.most_pairings", .why = "always 2000"},
    {.key = "corners.arc", .why = "always 12"},
    {.key = "ekf.capacity", .now = "map.capacity", .dropped_value = "1000"},
    {.key = "ekf.evict", .why = "the least informative landmark is always removed from a full map"},
    {.key = "ekf.region", .why = "always 64"},
    {.key = "ekf.speed_scale_sigma", .now = "motion.speed_scale_sigma", .dropped_value = "0.1"},
    {.key = "ekf.turn_bias_sigma_degps", .now = "motion.turn_bias_sigma_degps", .dropped_value = "0.1"},
    {.key = "ekf.turn_scale_sigma", .now = "motion.turn_scale_sigma", .dropped_value = "0.1"},
    {.key = "ekf.update", .why = kOfArticle},
    {.key = "fastslam.capacity", .now = "map.capacity", .dropped_value = "1000"},
    {.key = "fastslam.evidence_way_m", .now = "fastslam.information_distance_m"},
    {.key = "fastslam.init",
     .why = "a landmark that was observed by range or bearing alone always starts as a whole ring or ray"},
    {.key = "fastslam.kld_error", .why = "the number of particles stays fastslam.particles"},
    {.key = "fastslam.kld_least", .why = "the number of particles stays fastslam.particles"},
    {.key = "fastslam.move_above", .now = "fastslam.enkf_above"},
    {.key = "fastslam.resample_below", .why = "always 0.5, or set fastslam.always_resample=true"},
    {.key = "fastslam.temper_below", .why = "always 0.1, or set fastslam.always_resample=true"},
    {.key = "markers.max_tilt_deg", .why = "always 75"},
    {.key = "markers.mount_sigma_deg", .now = "camera.jitter_deg", .dropped_value = "0.05"},
    {.key = "markers.own_thread", .why = "always true"},
    {.key = "motion.arc", .why = kOfArticle},
    {.key = "motion.standing_below_radps", .why = "always 0.02"},
    {.key = "pixel.capacity", .now = "map.capacity", .dropped_value = "100"},
    {.key = "pixel.depth_particles", .why = "always 100"},
    {.key = "pixel.depth_ratio", .why = "always 0.3"},
    {.key = "pixel.depth_spacing", .why = kOfArticle},
    {.key = "pixel.gate_probability", .why = "always 0.9999"},
    {.key = "pixel.init", .why = kOfArticle},
    {.key = "pixel.least_pictures", .why = "always 8"},
    {.key = "pixel.most_candidates", .now = "pixel.max_candidates"},
    {.key = "pixel.most_pictures", .why = "always 15"},
    {.key = "pixel.vibration_deg", .now = "camera.jitter_deg", .dropped_value = "0.05"},
    {.key = "pixel.wander_px", .now = "pixel.landmark_noise_px"},
    {.key = "search.match", .why = kOfArticle},
    {.key = "search.max_windows", .why = "always 2500"},
    {.key = "search.probability", .why = "always 0.9999"},
    {.key = "sensor.lasting_bearing_sigma_deg", .now = "sensor.bias_bearing_sigma_deg"},
    {.key = "sensor.lasting_range_sigma_ratio", .now = "sensor.bias_range_sigma_ratio"},
    {.key = "sensor.lasting_way_m", .now = "sensor.bias_distance_m"},
    {.key = "smooth.least_leg_deg", .now = "smooth.keyframe_turn_deg"},
    {.key = "smooth.least_leg_m", .now = "smooth.keyframe_distance_m"},
    {.key = "smooth.most_iterations", .why = "always 50"},
    {.key = "smooth.speed_scale_sigma", .now = "motion.speed_scale_sigma", .dropped_value = "0.05"},
    {.key = "smooth.turn_bias_sigma_degps", .now = "motion.turn_bias_sigma_degps", .dropped_value = "0.1"},
    {.key = "smooth.turn_scale_sigma", .now = "motion.turn_scale_sigma", .dropped_value = "0.05"},
    {.key = "tracker.cells_u", .why = "always 4"},
    {.key = "tracker.cells_v", .why = "always 3"},
    {.key = "tracker.distance_px", .why = "always 20"},
    {.key = "tracker.kernels", .why = kOfArticle},
    {.key = "tracker.most_candidates", .now = "pixel.max_candidates", .dropped_value = "8"},
    {.key = "tracker.most_new", .why = "always 4"},
    {.key = "tracker.most_observed", .why = "always 30"},
    {.key = "tracker.patch_px", .why = "always 16"},
    {.key = "tracker.subpixel", .why = kOfArticle},
    {.key = "tracker.warp", .why = kOfArticle},
});

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
  Migration(const std::string& yaml, const std::string& name, const std::vector<FlatYamlEntry>& entries)
      : name_(name), lines_(split_lines(yaml)) {
    for (const FlatYamlEntry& entry : entries)
      if (find_former_key(entry.key) == nullptr) values_.insert_or_assign(entry.key, entry.value);
  }

  Result<void> replace(const FlatYamlEntry& entry, const FormerKey& former) {
    std::string& line = lines_[static_cast<std::size_t>(entry.line) - 1];
    const std::string written = key_written_in(line);
    if (written != former.key && written != last_part(former.key))
      return refuse(entry, former, "; this line holds more than that key, so change it by hand");
    const bool is_needed = !former.now.empty() && entry.value != former.dropped_value;
    const auto known = is_needed ? values_.find(former.now) : values_.end();
    if (known != values_.end() && known->second != entry.value)
      return refuse(entry, former, ", which this file sets twice, to different values; keep one of them");
    if (is_needed && known == values_.end())
      write(entry, former, line, written);
    else
      comment_out(line, former);
    return {};
  }

  [[nodiscard]] std::string text() const {
    std::string all;
    for (const auto& line : lines_) all += line + "\n";
    return all + moved_;
  }

 private:
  /// What stands before the first colon; nothing where there is none.
  static std::string key_written_in(const std::string& line) {
    const std::size_t begin = line.find_first_not_of(' ');
    const std::size_t colon = line.find(':');
    return colon == std::string::npos ? std::string() : line.substr(begin, colon - begin);
  }

  /// Under its new name: in its place where the section is the same, else at the end.
  void write(const FlatYamlEntry& entry, const FormerKey& former, std::string& line,
             const std::string& written) {
    values_.emplace(former.now, entry.value);
    if (section_of(former.key) == section_of(former.now)) {
      const bool is_whole = written == former.key;
      line.replace(line.find(written), written.size(), is_whole ? former.now : last_part(former.now));
      return;
    }
    moved_ += fmt::format("{}: {}\n", former.now, entry.value);
    comment_out(line, former);
  }

  static void comment_out(std::string& line, const FormerKey& former) {
    const std::size_t indent = line.find_first_not_of(' ');
    line = fmt::format("{}# {}  # {}", line.substr(0, indent), line.substr(indent), what_became_of(former));
  }

  [[nodiscard]] Error refuse(const FlatYamlEntry& entry, const FormerKey& former,
                             std::string_view reason) const {
    return Error{fmt::format("{}:{}: {}{}", name_, entry.line, what_became_of(former), reason)};
  }

  const std::string& name_;
  std::vector<std::string> lines_;
  std::map<std::string, std::string, std::less<>> values_;  ///< of the result, by today's keys
  std::string moved_;                                       ///< lines of keys that left their section
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
  Migration migration(yaml, name, *entries);
  for (const FlatYamlEntry& entry : *entries)
    if (const FormerKey* former = find_former_key(entry.key))
      if (auto done = migration.replace(entry, *former); !done) return done.error();
  return migration.text();
}

}  // namespace waymark
