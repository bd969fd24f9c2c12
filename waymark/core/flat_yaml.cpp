#include "waymark/core/flat_yaml.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

namespace waymark {
namespace {

// Aliases may nest a map in itself, or unfold without end; no file that a person wrote is so deep or long.
constexpr std::ptrdiff_t kMaxDepth = 16;
constexpr std::size_t kMaxEntries = 10000;

class Flattener {
 public:
  explicit Flattener(const std::string& name) : name_(name) {}

  Result<void> add(const YAML::Node& map, const std::string& prefix) {
    for (const auto& entry : map)
      if (auto done = add_entry(entry.first, entry.second, prefix); !done) return done;
    return {};
  }

  std::vector<FlatYamlEntry> entries;

 private:
  Result<void> add_entry(const YAML::Node& key_node, const YAML::Node& value, const std::string& prefix) {
    const int line = key_node.Mark().line + 1;
    if (std::ranges::count(prefix, '.') > kMaxDepth || entries.size() > kMaxEntries)
      return Error{
          fmt::format("{}:{}: sections are nested too deep, or unfold to too many entries", name_, line)};
    if (!key_node.IsScalar()) return Error{fmt::format("{}:{}: a key must be a plain name", name_, line)};
    const std::string key = prefix + key_node.Scalar();
    if (value.IsMap()) return add(value, key + '.');
    if (value.IsSequence()) return Error{fmt::format("{}:{}: {} cannot be a list", name_, line, key)};
    if (value.IsNull() && !prefix.empty())
      return Error{fmt::format("{}:{}: {} has no value", name_, line, key)};
    if (value.IsScalar()) entries.push_back({key, value.Scalar(), line});
    return {};
  }

  const std::string& name_;
};

}  // namespace

Result<std::vector<FlatYamlEntry>> flatten_yaml(const std::string& yaml, const std::string& name) {
  try {
    const YAML::Node root = YAML::Load(yaml);
    if (!root.IsMap() && !root.IsNull()) return Error{name + ":1: expected lines of `key: value`"};
    Flattener flattener(name);
    if (auto done = flattener.add(root, ""); !done) return done.error();
    return std::move(flattener.entries);
  } catch (const YAML::Exception& problem) {
    return Error{fmt::format("{}:{}: {}", name, problem.mark.line + 1, problem.msg)};
  }
}

}  // namespace waymark
