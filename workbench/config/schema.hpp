#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "waymark/core/result.hpp"

namespace waymark {

/// The smallest and largest value that a key may take.
struct ValueLimits {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
};

/// Whether `waymark config` shows a key: always are those that a page of docs/ tells a user to set.
enum class Shown : std::uint8_t { kOnRequest, kAlways };

/// Binds config keys to the fields of plain option structs: every key has a name that carries its unit, a
/// default (what the field holds when it is added), limits, and one line of help. The fields must outlive the
/// schema.
///
///     struct GateOptions { double probability = 0.999; };
///     void describe(Schema& schema, GateOptions& o) {
///       schema.real("gate.probability", o.probability, {0.5, 1.0}, "part of the true observations that may
///       pass");
///     }
class Schema {
 public:
  void real(std::string name, double& field, ValueLimits limits, std::string help,
            Shown shown = Shown::kOnRequest);
  void integer(std::string name, int& field, ValueLimits limits, std::string help,
               Shown shown = Shown::kOnRequest);
  void integer(std::string name, std::uint64_t& field, ValueLimits limits, std::string help,
               Shown shown = Shown::kOnRequest);
  void boolean(std::string name, bool& field, std::string help, Shown shown = Shown::kOnRequest);
  /// One key for a choice that is made of several fields.
  void boolean(std::string name, std::function<bool()> get, std::function<void(bool)> set, std::string help,
               Shown shown = Shown::kOnRequest);
  void text(std::string name, std::string& field, std::string help, Shown shown = Shown::kOnRequest);

  /// One of `names`; enumerators must count up from 0 in their order.
  template <class Enum>
  void choice(std::string name, Enum& field, std::vector<std::string> names, std::string help,
              Shown shown = Shown::kOnRequest) {
    add_choice(
        std::move(name), std::move(names), std::move(help), shown,
        [&field] { return static_cast<std::size_t>(field); },
        [&field](std::size_t index) { field = static_cast<Enum>(index); });
  }

  /// Sets one key from text. `where` (a file and line, "--set", ...) begins the error.
  /// An unknown key names the nearest known one, a former one (former_keys.hpp) what became of it; an
  /// impossible value names what would be right.
  Result<void> set(std::string_view key, std::string_view value, std::string_view where);

  /// The same where a flag of the command line sets a key: `flag` ("--filter") stands for the key in the
  /// error.
  Result<void> set_by_flag(std::string_view flag, std::string_view key, std::string_view value);

  /// "key=value", as on the command line.
  Result<void> set_assignment(std::string_view assignment, std::string_view where);

  /// Reads a YAML file of nested sections; stops at the first error, named with file and line.
  Result<void> load_file(const std::filesystem::path& path);
  /// The same from memory; `name` stands for the file in errors.
  Result<void> load_text(const std::string& yaml, const std::string& name);

  /// The config in force as YAML with help, unit and limits as comments: the keys that `is_wanted` takes, all
  /// without it. load_text() of it changes nothing.
  [[nodiscard]] std::string to_yaml(const std::function<bool(const std::string&)>& is_wanted = {}) const;

  /// The same with every key that nobody set behind a `#`: a file to edit, which leaves to the log what it
  /// does not set.
  [[nodiscard]] std::string to_template(const std::function<bool(const std::string&)>& is_wanted) const;

  [[nodiscard]] bool has(std::string_view key) const { return find(key) != nullptr; }
  [[nodiscard]] bool is_shown(std::string_view key) const;
  /// Has anyone set it, be it to its default?
  [[nodiscard]] bool was_set(std::string_view key) const;
  /// The text of the value in force; the key must exist.
  [[nodiscard]] std::string value(std::string_view key) const;
  [[nodiscard]] std::vector<std::string> keys() const;
  /// What a key that is a real number may be; nothing for any other.
  [[nodiscard]] std::optional<ValueLimits> limits(std::string_view key) const;
  /// The keys that a mistyped one may have meant, the likeliest first, at most `count` of them; may be none.
  [[nodiscard]] std::vector<std::string> close_keys(std::string_view name, std::size_t count) const;

 private:
  struct Key {
    std::string name;
    std::string help;
    std::string allowed;  ///< "0.5 to 1", "true or false", "ekf or fastslam"
    std::function<std::string()> get;
    std::function<bool(std::string_view)> set;  ///< false: not an allowed value
    Shown shown = Shown::kOnRequest;
    std::optional<ValueLimits> limits = std::nullopt;  ///< of a real number
    std::string default_value = {};
    bool was_set = false;
  };

  void add(Key key);
  static Result<void> set(Key& key, std::string_view value, std::string_view subject);
  template <class Number>
  void add_number(std::string name, Number& field, ValueLimits limits, std::string allowed, std::string help,
                  Shown shown);
  void add_choice(std::string name, std::vector<std::string> names, std::string help, Shown shown,
                  std::function<std::size_t()> get, std::function<void(std::size_t)> set);
  [[nodiscard]] const Key* find(std::string_view name) const;
  [[nodiscard]] std::string nearest(std::string_view name) const;
  template <class IsWanted, class IsComment>
  [[nodiscard]] std::string write_yaml(const IsWanted& is_wanted, const IsComment& is_comment) const;

  std::vector<Key> keys_;
};

}  // namespace waymark
