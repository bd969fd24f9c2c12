#include "workbench/config/schema.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstddef>
#include <memory>
#include <optional>

#include <fmt/format.h>

#include "waymark/core/names.hpp"

#include "workbench/config/flat_yaml.hpp"
#include "workbench/config/former_keys.hpp"
#include "workbench/config/key_parts.hpp"
#include "workbench/config/read_file.hpp"

namespace waymark {
namespace {

template <class Number>
std::optional<Number> parse_number(std::string_view text) {
  Number number{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return number;
}

std::string describe_limits(ValueLimits limits) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  if (limits.low == -kInfinity && limits.high == kInfinity) return "any number";
  if (limits.high == kInfinity) return fmt::format("at least {}", limits.low);
  if (limits.low == -kInfinity) return fmt::format("at most {}", limits.high);
  return fmt::format("{} to {}", limits.low, limits.high);
}

/// The text as YAML reads it back: in double quotes, with escapes, unless it is surely a plain scalar.
std::string yaml_scalar(const std::string& text) {
  const auto is_plain = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '.' || c == '/';
  };
  const bool null = text == "null" || text == "Null" || text == "NULL";
  if (parse_number<double>(text) || (!text.empty() && !null && std::ranges::all_of(text, is_plain)))
    return text;
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') quoted += '\\';
    quoted += static_cast<unsigned char>(c) < 0x20 ? fmt::format("\\x{:02x}", static_cast<unsigned>(c))
                                                   : std::string(1, c);
  }
  return quoted + "\"";
}

}  // namespace

void Schema::add(Key key) {
  key.default_value = key.get();
  keys_.push_back(std::move(key));
}

template <class Number>
void Schema::add_number(std::string name, Number& field, ValueLimits limits, std::string allowed,
                        std::string help, Shown shown) {
  auto set = [&field, limits](std::string_view text) {
    const auto number = parse_number<Number>(text);
    const bool is_allowed =
        number && static_cast<double>(*number) >= limits.low && static_cast<double>(*number) <= limits.high;
    if (is_allowed) field = *number;
    return is_allowed;
  };
  add({std::move(name), std::move(help), std::move(allowed), [&field] { return fmt::format("{}", field); },
       std::move(set), shown});
}

void Schema::real(std::string name, double& field, ValueLimits limits, std::string help, Shown shown) {
  add_number(std::move(name), field, limits, describe_limits(limits), std::move(help), shown);
  keys_.back().limits = limits;
}

void Schema::integer(std::string name, int& field, ValueLimits limits, std::string help, Shown shown) {
  add_number(std::move(name), field, limits, "whole number, " + describe_limits(limits), std::move(help),
             shown);
}

void Schema::integer(std::string name, std::uint64_t& field, ValueLimits limits, std::string help,
                     Shown shown) {
  add_number(std::move(name), field, limits, "whole number, " + describe_limits(limits), std::move(help),
             shown);
}

void Schema::boolean(std::string name, std::function<bool()> get, std::function<void(bool)> set,
                     std::string help, Shown shown) {
  auto set_by_name = [set = std::move(set)](std::string_view text) {
    if (text != "true" && text != "false") return false;
    set(text == "true");
    return true;
  };
  add({std::move(name), std::move(help), "true or false",
       [get = std::move(get)] { return std::string(get() ? "true" : "false"); }, std::move(set_by_name),
       shown});
}

void Schema::boolean(std::string name, bool& field, std::string help, Shown shown) {
  boolean(
      std::move(name), [&field] { return field; }, [&field](bool value) { field = value; }, std::move(help),
      shown);
}

void Schema::text(std::string name, std::string& field, std::string help, Shown shown) {
  auto set = [&field](std::string_view text) {
    field = text;
    return true;
  };
  add({std::move(name), std::move(help), "text", [&field] { return field; }, std::move(set), shown});
}

void Schema::add_choice(std::string name, std::vector<std::string> names, std::string help, Shown shown,
                        std::function<std::size_t()> get, std::function<void(std::size_t)> set) {
  auto shared = std::make_shared<const std::vector<std::string>>(std::move(names));
  auto set_by_name = [shared, set = std::move(set)](std::string_view text) {
    const auto found = std::ranges::find(*shared, text);
    if (found == shared->end()) return false;
    set(static_cast<std::size_t>(found - shared->begin()));
    return true;
  };
  add({std::move(name), std::move(help), one_of(*shared),
       [shared, get = std::move(get)] { return (*shared)[get()]; }, std::move(set_by_name), shown});
}

const Schema::Key* Schema::find(std::string_view name) const {
  const auto found = std::ranges::find(keys_, name, &Key::name);
  return found == keys_.end() ? nullptr : &*found;
}

std::vector<std::string> Schema::keys() const {
  std::vector<std::string> names;
  for (const auto& key : keys_) names.push_back(key.name);
  return names;
}

std::vector<std::string> Schema::close_keys(std::string_view name, std::size_t count) const {
  // The last part counts as much as the whole: sections are what is left out or mistaken.
  const auto distance = [&](const std::string& key) {
    return std::min(edit_distance(name, key), edit_distance(last_part(name), last_part(key)));
  };
  std::vector<std::string> names = keys();
  std::erase_if(names, [&](const auto& key) {
    return distance(key) > std::max<std::size_t>(1, last_part(name).size() / 3);
  });
  std::ranges::stable_sort(names, {}, distance);
  names.resize(std::min(count, names.size()));
  return names;
}

std::optional<ValueLimits> Schema::limits(std::string_view key) const {
  const Key* found = find(key);
  return found == nullptr ? std::nullopt : found->limits;
}

std::string Schema::value(std::string_view key) const { return find(key)->get(); }

/// A key typed without its section, or with a wrong one, is nearest to the key with the same last part.
std::string Schema::nearest(std::string_view name) const {
  std::vector<std::string> same;
  for (const auto& key : keys_)
    if (last_part(key.name) == last_part(name)) same.push_back(key.name);
  if (same.empty()) return nearest_name(name, keys());
  return *std::ranges::min_element(same, {},
                                   [name](const std::string& key) { return edit_distance(key, name); });
}

bool Schema::is_shown(std::string_view key) const {
  const Key* found = find(key);
  return found != nullptr && found->shown == Shown::kAlways;
}

bool Schema::was_set(std::string_view key) const {
  const Key* found = find(key);
  return found != nullptr && found->was_set;
}

Result<void> Schema::set(std::string_view key, std::string_view value, std::string_view where) {
  const auto found = std::ranges::find(keys_, key, &Key::name);
  if (found == keys_.end()) {
    if (const FormerKey* former = find_former_key(key))
      return Error{fmt::format("{}: {}; `waymark config --migrate FILE` updates a file", where,
                               what_became_of(*former))};
    const std::string guess = nearest(key);
    return Error{fmt::format("{}: unknown key {}{}", where, key,
                             guess.empty() ? "; `waymark config --all` lists all keys"
                                           : fmt::format("; did you mean {}?", guess))};
  }
  return set(*found, value, fmt::format("{}: {}", where, key));
}

Result<void> Schema::set_by_flag(std::string_view flag, std::string_view key, std::string_view value) {
  return set(*std::ranges::find(keys_, key, &Key::name), value, flag);
}

/// `subject` begins the error.
Result<void> Schema::set(Key& key, std::string_view value, std::string_view subject) {
  if (!key.set(value))
    return Error{fmt::format("{} cannot be '{}'; allowed: {}{}", subject, value,
                             key.limits ? "a number, " : "", key.allowed)};
  key.was_set = true;
  return {};
}

Result<void> Schema::set_assignment(std::string_view assignment, std::string_view where) {
  const std::size_t equals = assignment.find('=');
  if (equals == std::string_view::npos)
    return Error{fmt::format("{}: '{}' is not of the form key=value", where, assignment)};
  return set(assignment.substr(0, equals), assignment.substr(equals + 1), where);
}

Result<void> Schema::load_text(const std::string& yaml, const std::string& name) {
  const auto entries = flatten_yaml(yaml, name);
  if (!entries) return entries.error();
  for (const auto& [key, value, line] : *entries)
    if (auto done = set(key, value, fmt::format("{}:{}", name, line)); !done) return done;
  return {};
}

Result<void> Schema::load_file(const std::filesystem::path& path) {
  const auto text = read_file(path);
  return text ? load_text(*text, path.string()) : text.error();
}

std::string Schema::to_yaml(const std::function<bool(const std::string&)>& is_wanted) const {
  return write_yaml([&](const Key& key) { return !is_wanted || is_wanted(key.name); },
                    [](const Key&) { return false; });
}

std::string Schema::to_template(const std::function<bool(const std::string&)>& is_wanted) const {
  return write_yaml([&](const Key& key) { return is_wanted(key.name); },
                    [](const Key& key) { return !key.was_set; });
}

template <class IsWanted, class IsComment>
std::string Schema::write_yaml(const IsWanted& is_wanted, const IsComment& is_comment) const {
  std::vector<const Key*> wanted;
  for (const auto& key : keys_)
    if (is_wanted(key)) wanted.push_back(&key);
  std::vector<std::string_view> sections;
  for (const Key* key : wanted)
    if (std::ranges::find(sections, section_of(key->name)) == sections.end())
      sections.push_back(section_of(key->name));
  std::string yaml;
  for (const std::string_view section : sections) {
    if (!section.empty()) yaml += fmt::format("\n{}:\n", section.substr(0, section.size() - 1));
    const std::string indent = section.empty() ? "" : "  ";
    for (const Key* key : wanted) {
      if (section_of(key->name) != section) continue;
      yaml += fmt::format("{}# {} ({}; default {})\n", indent, key->help, key->allowed,
                          key->default_value.empty() ? "empty" : yaml_scalar(key->default_value));
      yaml += fmt::format("{}{}{}: {}\n", indent, is_comment(*key) ? "#" : "",
                          key->name.substr(section.size()), yaml_scalar(key->get()));
    }
  }
  return yaml;
}

}  // namespace waymark
