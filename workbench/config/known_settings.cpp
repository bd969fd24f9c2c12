#include "workbench/config/known_settings.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "workbench/config/flat_yaml.hpp"
#include "workbench/config/known_settings_text.hpp"

namespace waymark {

Result<std::vector<std::pair<std::string, std::string>>> known_settings(std::string_view name) {
  const std::string file = fmt::format("configs/{}.yaml", name);
  const auto texts = known_settings_texts();
  const auto text = std::ranges::find(texts, name, &SettingsText::name);
  if (text == texts.end()) return Error{file + " is not built into this program"};
  const auto entries = flatten_yaml(text->yaml, file);
  if (!entries) return entries.error();
  std::vector<std::pair<std::string, std::string>> settings;
  for (const auto& entry : *entries) settings.emplace_back(entry.key, entry.value);
  return settings;
}

}  // namespace waymark
