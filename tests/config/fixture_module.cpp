// A module whose functions are one number.

#include "workbench/config/module.hpp"
#include "workbench/config/module_version.hpp"

namespace {

constexpr int kNumber = 42;

}  // namespace

extern "C" const waymark::Module waymark_module;
const waymark::Module waymark_module{waymark::kModuleVersion, &kNumber};
