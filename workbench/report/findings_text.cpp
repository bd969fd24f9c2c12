#include "workbench/report/findings_text.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "workbench/logs/json_text.hpp"
#include "workbench/report/rounded.hpp"

namespace waymark {

std::string findings_text(const std::vector<calibrate::CalibrationFinding>& findings, int runs,
                          const std::string& input) {
  std::string text =
      fmt::format("{} runs over {}\n  {:<30}{:>11}{:>13}\n", runs, input, "", "before", "found");
  for (const auto& [found, before, is_key] : findings)
    text += fmt::format("  {:<30}{:>11.5f}{:>13.5f} +- {:.5f}{}\n", found.key, before, found.value,
                        found.sigma, found.is_unobservable ? "   (prior: not observable)" : "");
  return text;
}

std::string findings_json(const std::vector<calibrate::CalibrationFinding>& findings) {
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  for (const auto& [found, before, is_key] : findings)
    json[found.key] = {{"value", rounded(found.value)},
                       {"sigma", rounded(found.sigma)},
                       {"before", rounded(before)},
                       {"told", !found.is_unobservable}};
  return json_text(json);
}

}  // namespace waymark
