#include <cstdio>
#include <memory>

#include <fmt/format.h>

#include "commands.hpp"

namespace waymark::app {
namespace {

struct ConfigRequest {
  std::string validate;
  SettingsFlags flags;
};

Result<void> config(const ConfigRequest& request) {
  UserSettings user = request.flags.settings();
  if (!request.validate.empty()) user.files.emplace_back(request.validate);
  auto config = resolve_config(user);
  if (!config) return config.error();
  if (!request.validate.empty())
    fmt::print("{}: valid\n", request.validate);
  else
    fmt::print("{}", describe(*config).to_yaml());
  return {};
}

}  // namespace

void add_config(CLI::App& app, Work& work) {
  auto* command = app.add_subcommand("config", "Print the full config with comments, or validate a file");
  auto request = std::make_shared<ConfigRequest>();
  command->add_option("--validate", request->validate, "check this file and say what is wrong with it")
      ->type_name("FILE");
  request->flags.add_to(*command);
  command->footer("Example:\n  waymark config > my.yaml\n  waymark config --validate my.yaml");
  command->callback([&work, request] { work = [request] { return config(*request); }; });
}

}  // namespace waymark::app
