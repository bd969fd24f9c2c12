#include <cstdio>
#include <memory>

#include <fmt/format.h>

#include "waymark/core/names.hpp"

#include "commands.hpp"
#include "workbench/config/former_keys.hpp"
#include "workbench/config/read_file.hpp"
#include "workbench/logs/files.hpp"

namespace waymark::app {
namespace {

struct ConfigRequest {
  std::string prefix;
  bool all = false;
  std::string validate;
  std::string migrate;
  SettingsFlags flags;
};

/// What is written can be read; where it cannot, the file stays.
Result<void> migrate(const std::string& file) {
  const auto text = read_file(file);
  if (!text) return text.error();
  const auto migrated = migrate_config(*text, file);
  if (!migrated) return migrated.error();
  Config config;
  if (auto valid = describe(config).load_text(*migrated, file); !valid) return valid;
  if (*migrated == *text) {
    fmt::print("{}: nothing to change\n", file);
    return {};
  }
  if (auto written = write_file(file, *migrated); !written) return written;
  fmt::print("{}: rewritten\n", file);
  return {};
}

/// What a prefix may be meant for: a section, or a key.
std::vector<std::string> beginnings_of(const Schema& schema) {
  std::vector<std::string> beginnings = schema.keys();
  for (const std::string& key : schema.keys()) beginnings.push_back(key.substr(0, key.find('.')));
  return beginnings;
}

Result<void> print(const ConfigRequest& request, const Schema& schema) {
  const std::string yaml = schema.to_template([&](const std::string& key) {
    if (!request.prefix.empty()) return key.starts_with(request.prefix);
    return request.all || schema.is_shown(key);
  });
  if (yaml.empty()) {
    const std::string near = nearest_name(request.prefix, beginnings_of(schema));
    return Error{fmt::format("no key starts with {}{}; `waymark config --all` lists all keys", request.prefix,
                             near.empty() ? "" : fmt::format("; did you mean {}?", near))};
  }
  fmt::print("{}", yaml);
  return {};
}

Result<void> config(const ConfigRequest& request) {
  if (!request.migrate.empty()) return migrate(request.migrate);
  UserSettings user = request.flags.settings();
  if (!request.validate.empty()) user.files.emplace_back(request.validate);
  Config config;
  Schema schema = describe(config);
  if (auto done = apply(schema, user); !done) return done;
  if (request.validate.empty()) return print(request, schema);
  fmt::print("{}: valid\n", request.validate);
  return {};
}

}  // namespace

void add_config(CLI::App& app, Work& work) {
  auto* command = app.add_subcommand(
      "config",
      "Print config keys with descriptions, as a config file in which keys that are not set are comments; "
      "validate a config file, or migrate one of an earlier version");
  auto request = std::make_shared<ConfigRequest>();
  command
      ->add_option("prefix", request->prefix,
                   "print only keys that start with this, for example sensor or camera.mount")
      ->type_name("PREFIX");
  command->add_flag("--all", request->all, "print all keys, including those that are seldom set");
  auto* validate =
      command->add_option("--validate", request->validate, "check this file and report its first error")
          ->type_name("FILE");
  command
      ->add_option("--migrate", request->migrate,
                   "rewrite this file of an earlier version: renamed keys get their new names, removed keys "
                   "become comments")
      ->type_name("FILE")
      ->excludes(validate);
  request->flags.add_to(*command);
  command->footer(
      "Examples:\n  waymark config > my.yaml\n  waymark config sensor\n  waymark config --validate my.yaml\n"
      "  waymark config --migrate old.yaml");
  command->callback([&work, request] { work = [request] { return config(*request); }; });
}

}  // namespace waymark::app
