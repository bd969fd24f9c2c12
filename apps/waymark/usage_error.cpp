#include "usage_error.hpp"

#include <algorithm>
#include <cctype>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "waymark/core/names.hpp"

namespace waymark::app {
namespace {

/// The subcommand that was typed, in the words that lead to it: "waymark calibrate camera".
struct TypedCommand {
  const CLI::App* command;
  std::string words;

  /// What a message about it begins with.
  [[nodiscard]] std::string prefix() const {
    return command->get_parent() == nullptr ? "" : command->get_name() + ": ";
  }
};

TypedCommand typed_command(const CLI::App& app) {
  TypedCommand typed{&app, app.get_name()};
  while (!typed.command->get_subcommands().empty()) {
    typed.command = typed.command->get_subcommands().front();
    typed.words += " " + typed.command->get_name();
  }
  return typed;
}

std::vector<std::string> subcommand_names(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::App* each : command.get_subcommands([](const CLI::App*) { return true; }))
    names.push_back(each->get_name());
  return names;
}

std::vector<std::string> option_names(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options())
    for (const std::string& name : option->get_lnames()) names.push_back(name);
  return names;
}

std::string unknown_option(const TypedCommand& typed, const std::string& name) {
  const std::string bare = name.substr(std::min(name.find_first_not_of('-'), name.size()));
  const std::string near = nearest_name(bare, option_names(*typed.command));
  return "unknown option " + name + (near.empty() ? "" : fmt::format("; did you mean --{}?", near));
}

std::string unknown_argument(const TypedCommand& typed, const std::string& word) {
  const auto known = subcommand_names(*typed.command);
  if (known.empty()) return fmt::format("unexpected argument '{}'", word);
  const std::string near = nearest_name(word, known);
  return fmt::format("unknown command '{}'{}", word,
                     near.empty() ? "" : fmt::format("; did you mean {}?", near));
}

std::string unknown_word(const TypedCommand& typed, const std::string& word) {
  const std::string what = word.starts_with('-') ? unknown_option(typed, word.substr(0, word.find('=')))
                                                 : unknown_argument(typed, word);
  return fmt::format("{}{}{} `{} --help`", typed.prefix(), what, what.ends_with('?') ? " See" : "; see",
                     typed.words);
}

/// "a second map" of SECOND_MAP, "images" of IMAGES.
std::string in_words(std::string type_name) {
  std::ranges::transform(type_name, type_name.begin(),
                         [](unsigned char c) { return c == '_' ? ' ' : static_cast<char>(std::tolower(c)); });
  return type_name.ends_with('s') ? type_name : "a " + type_name;
}

/// An option as it is typed: LOG, --truth LOG.
std::string typed_as(const CLI::Option& option) {
  return option.get_positional() ? option.get_type_name() : option.get_name() + " " + option.get_type_name();
}

std::string missing_option(const TypedCommand& typed, const std::vector<const CLI::Option*>& required,
                           const CLI::Option& missing) {
  std::string usage = typed.words;
  for (const CLI::Option* option : required) usage += " " + typed_as(*option);
  return fmt::format("give {}: `{}`",
                     missing.get_positional() ? in_words(missing.get_type_name()) : typed_as(missing), usage);
}

/// What is required and was not given.
std::string missing_word(const TypedCommand& typed) {
  const auto required =
      typed.command->get_options([](const CLI::Option* option) { return option->get_required(); });
  const auto missing =
      std::ranges::find_if(required, [](const CLI::Option* option) { return option->count() == 0; });
  if (missing != required.end()) return missing_option(typed, required, **missing);
  return fmt::format("{}give a command: {}; see `{} --help`", typed.prefix(),
                     one_of(subcommand_names(*typed.command)), typed.words);
}

std::string describe(const TypedCommand& typed, const CLI::ParseError& wrong) {
  const bool is_missing = dynamic_cast<const CLI::RequiredError*>(&wrong) != nullptr;
  const bool is_extra = dynamic_cast<const CLI::ExtrasError*>(&wrong) != nullptr;
  const auto unknown = typed.command->remaining();
  if ((is_missing || is_extra) && !unknown.empty()) return unknown_word(typed, unknown.front());
  if (is_missing) return missing_word(typed);
  return fmt::format("{}; see `{} --help`", wrong.what(), typed.words);
}

}  // namespace

Error usage_error(const CLI::App& app, const CLI::ParseError& wrong) {
  return {describe(typed_command(app), wrong), Error::Kind::kBadInput};
}

}  // namespace waymark::app
