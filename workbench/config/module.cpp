#include "workbench/config/module.hpp"

#include <algorithm>
#include <cstdlib>
#include <string_view>
#include <system_error>

#include <dlfcn.h>
#include <fmt/format.h>

#include "workbench/config/module_version.hpp"

namespace waymark {
namespace {

namespace fs = std::filesystem;

fs::path folder_of_program() {
  std::error_code unknown;
  return fs::read_symlink("/proc/self/exe", unknown).parent_path();
}

bool is_file(const fs::path& path) {
  std::error_code missing;
  return fs::is_regular_file(path, missing);
}

Result<const void*> functions_of(const fs::path& path) {
  void* library = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr) return Error{fmt::format("{} cannot be loaded: {}", path.string(), dlerror())};
  const auto* module = static_cast<const Module*>(dlsym(library, "waymark_module"));
  if (module == nullptr) return Error{path.string() + " is not a module of Waymark"};
  if (std::string_view(module->version) != kModuleVersion)
    return Error{fmt::format("{} is from {}, but this program is from {}; build both together", path.string(),
                             module->version, kModuleVersion)};
  return module->functions;
}

}  // namespace

std::vector<fs::path> module_folders() {
  if (const char* only = std::getenv("WAYMARK_MODULE_DIR")) return {only};
  const fs::path program = folder_of_program();
  return {program, (program / ".." / WAYMARK_MODULE_DIR).lexically_normal(), WAYMARK_MODULE_FULL_DIR};
}

Result<const void*> load_module(const std::string& name, const std::vector<fs::path>& folders) {
  const std::string file = fmt::format("waymark-{}.so", name);
  const auto folder =
      std::ranges::find_if(folders, [&](const fs::path& each) { return is_file(each / file); });
  if (folder == folders.end()) return Error{fmt::format("{} is not installed", file)};
  return functions_of(*folder / file);
}

}  // namespace waymark
