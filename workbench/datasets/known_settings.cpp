#include "workbench/datasets/known_settings.hpp"

#include "workbench/config/flat_yaml.hpp"

namespace waymark {

Result<std::vector<std::pair<std::string, std::string>>> KnownSettings::flat() const {
  const auto entries = flatten_yaml(yaml, file);
  if (!entries) return entries.error();
  std::vector<std::pair<std::string, std::string>> settings;
  for (const auto& entry : *entries) settings.emplace_back(entry.key, entry.value);
  return settings;
}

}  // namespace waymark
