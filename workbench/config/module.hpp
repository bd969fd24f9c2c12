#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "waymark/core/result.hpp"

namespace waymark {

/// What a module exports, as extern "C" under the name `waymark_module`.
struct Module {
  const char* version;    ///< kModuleVersion of module_version.hpp
  const void* functions;  ///< a struct of pointers to them that the loader knows by the module's name
};

/// Where modules are looked for: in WAYMARK_MODULE_DIR alone where that is set; else beside the program, and
/// where they are installed, as seen from the program and by this build.
[[nodiscard]] std::vector<std::filesystem::path> module_folders();

/// The functions of module `name`, waymark-<name>.so in the first of the folders that has it. What is linked
/// with something large, or with what not everybody has, is a module and is loaded, for good, where it is
/// needed. An error where it is missing, cannot be loaded, or was not built with this program.
[[nodiscard]] Result<const void*> load_module(const std::string& name,
                                              const std::vector<std::filesystem::path>& folders);

}  // namespace waymark
