#include "workbench/config/flat_yaml.hpp"

#include <cstddef>
#include <utility>

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include "workbench/config/load_yaml.hpp"

namespace waymark {
namespace {

// What is gone through counts, not what comes of it: empty sections give no entries. No file that a person
// wrote has so much, or names of such a length.
constexpr std::size_t kMaxSteps = 10000;
constexpr std::size_t kMaxKeyLength = 500;

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
    if (++steps_ > kMaxSteps)
      return Error{fmt::format("{}:{}: too many keys (those of aliases count, too)", name_, line)};
    if (!key_node.IsScalar()) return Error{fmt::format("{}:{}: a key must be a plain name", name_, line)};
    const std::string key = prefix + key_node.Scalar();
    if (key.size() > kMaxKeyLength)
      return Error{fmt::format("{}:{}: a key of {} characters is too long", name_, line, key.size())};
    if (value.IsMap()) return add(value, key + '.');
    if (value.IsSequence()) return Error{fmt::format("{}:{}: {} cannot be a list", name_, line, key)};
    if (value.IsNull() && !prefix.empty())
      return Error{fmt::format("{}:{}: {} has no value", name_, line, key)};
    if (value.IsScalar()) entries.push_back({key, value.Scalar(), line});
    return {};
  }

  const std::string& name_;
  std::size_t steps_ = 0;
};

}  // namespace

Result<std::vector<FlatYamlEntry>> flatten_yaml(const std::string& yaml, const std::string& name) {
  const auto root = load_yaml(yaml, name);
  if (!root) return root.error();
  if (!root->IsMap() && !root->IsNull()) return Error{name + ":1: expected lines of `key: value`"};
  Flattener flattener(name);
  if (auto done = flattener.add(*root, ""); !done) return done.error();
  return std::move(flattener.entries);
}

}  // namespace waymark
