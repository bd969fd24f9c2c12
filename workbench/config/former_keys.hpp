#pragma once

#include <span>
#include <string>
#include <string_view>

#include "waymark/core/result.hpp"

namespace waymark {

/// A key of earlier versions.
struct FormerKey {
  std::string_view key;
  std::string_view now = {};  ///< the key that does the same; empty: none does
  std::string_view why = {};  ///< what holds instead where none does, in a few words
  /// What it was where nobody set it, if that need not be carried over: two keys that became one had two
  /// defaults.
  std::string_view dropped_value = {};
};

[[nodiscard]] std::span<const FormerKey> former_keys();
/// Null where there never was such a key, or where it is still there.
[[nodiscard]] const FormerKey* find_former_key(std::string_view key);

/// For a person: "a is now b", or "a was removed: why".
[[nodiscard]] std::string what_became_of(const FormerKey& former);

/// A config file (YAML, `name` in errors) of an earlier version as one of today: a key that was renamed has
/// its new name, in its place where the section is the same and else at the end; one that is gone, or whose
/// value is there already, is left in a comment. All other lines stay as they are. Refused where a line holds
/// more than its key, and where a key of today would have two different values.
[[nodiscard]] Result<std::string> migrate_config(const std::string& yaml, const std::string& name);

}  // namespace waymark
