#pragma once

#include <string>
#include <vector>

#include "waymark/core/result.hpp"

namespace waymark {

/// One value of a tree of YAML sections: `wheels: {track_m: 0.3}` is "wheels.track_m", "0.3".
struct FlatYamlEntry {
  std::string key;
  std::string value;
  int line = 0;
};

/// All values in the order of the text; empty sections are left out. `name` stands for the file in errors.
/// Lists and keys without a value are refused, and so is what unfolds without end.
[[nodiscard]] Result<std::vector<FlatYamlEntry>> flatten_yaml(const std::string& yaml,
                                                              const std::string& name);

}  // namespace waymark
