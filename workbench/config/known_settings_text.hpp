#pragma once

#include <span>
#include <string_view>

namespace waymark {

/// configs/NAME.yaml as it is; NAME may be "sim/NAME".
struct SettingsText {
  std::string_view name;
  const char* yaml;
};

/// All of configs/, built in.
[[nodiscard]] std::span<const SettingsText> known_settings_texts();

}  // namespace waymark
