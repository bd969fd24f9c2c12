#include "workbench/study/tune_text.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "workbench/config/key_parts.hpp"
#include "workbench/study/sweep_summary.hpp"

namespace waymark::study {
namespace {

std::string figure_text(const Figures& figures, std::string_view name) {
  const double value = figures[figure_index(name)];
  return std::isnan(value) ? "-" : fmt::format("{:.3g}", value);
}

std::string pair_text(const TunedLog& log, std::string_view name) {
  return figure_text(log.figures_before, name) + " > " + figure_text(log.figures_after, name);
}

}  // namespace

std::string interval_text(const TunedKey& key) {
  if (!key.interval) return "";
  if (key.open_low && key.open_high) return "any value: not observable";
  if (key.open_low) return "below " + tuned_text(key.interval->second);
  if (key.open_high) return "above " + tuned_text(key.interval->first);
  return fmt::format("{} to {}", tuned_text(key.interval->first), tuned_text(key.interval->second));
}

std::string score_name(TuneBy by) {
  return by == TuneBy::kLikelihood ? "log-likelihood per observation" : "aligned position RMSE, m";
}

static std::string scores_text(const TuneResult& result) {
  return fmt::format("{}: {:.4g} before, {:.4g} after\n", score_name(result.by), result.before, result.after);
}

std::string to_yaml(const TuneResult& result) {
  std::vector<const TunedKey*> keys;
  for (const TunedKey& key : result.keys) keys.push_back(&key);
  std::ranges::stable_sort(keys, {}, [](const TunedKey* key) { return section_of(key->name); });
  std::string yaml = fmt::format("# Tuned over {} observations; ", result.observations) +
                     (result.stopped ? "stopped early.\n" : scores_text(result));
  std::string section;
  for (const TunedKey* key : keys) {
    if (section_of(key->name) != section) {
      section = section_of(key->name);
      if (!section.empty()) yaml += section.substr(0, section.size() - 1) + ":\n";
    }
    const std::string interval = interval_text(*key);
    yaml +=
        fmt::format("{}{}: {}  # was {}{}\n", section.empty() ? "" : "  ", key->name.substr(section.size()),
                    tuned_text(key->after), tuned_text(key->before), interval.empty() ? "" : "; " + interval);
  }
  return yaml;
}

std::string to_text(const TuneResult& result) {
  std::size_t width = 4;
  for (const TunedKey& key : result.keys) width = std::max(width, key.name.size());
  std::string text = fmt::format("{:<{}}{:>11}{:>11}  good\n", "key", width, "before", "after");
  for (const TunedKey& key : result.keys)
    text += fmt::format("{:<{}}{:>11}{:>11}  {}\n", key.name, width, tuned_text(key.before),
                        tuned_text(key.after), interval_text(key));
  if (!result.stopped) text += scores_text(result);
  if (!result.held_out.empty()) text += "the same on parts of the data that were left out of the fit:\n";
  for (const HeldOutLog& part : result.held_out)
    text += fmt::format("  {:<40}{:>9.4g}{:>9.4g}\n", part.name, part.before, part.after);
  for (const TunedLog& log : result.logs)
    text += fmt::format("{}: NIS per dof {}, path RMSE anchored {} m, aligned {} m, NEES {}\n", log.name,
                        pair_text(log, "nis_per_dof"), pair_text(log, "position_rmse_m"),
                        pair_text(log, "position_rmse_aligned_m"), pair_text(log, "nees_median"));
  for (const auto& key : result.idle_keys) text += "not tuned: " + key + " has no effect here\n";
  return text;
}

}  // namespace waymark::study
