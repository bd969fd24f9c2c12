#pragma once

#include <string>

#include "waymark/core/result.hpp"

namespace YAML {
class Node;
}

namespace waymark {

/// A text of YAML as a tree. It is gone through once before, without being kept: what is too large or too
/// deep, or comes to too much once every alias is replaced by what it stands for, is refused in time that
/// grows with the length of the text alone. Whoever walks through the tree may therefore follow aliases
/// without counting. `name` stands for the file in errors.
[[nodiscard]] Result<YAML::Node> load_yaml(const std::string& yaml, const std::string& name);

}  // namespace waymark
