// A module whose functions are one number.

#include "waymark/core/module.hpp"
#include "waymark/core/module_version.hpp"

namespace {

constexpr int kNumber = 42;

}  // namespace

extern "C" const waymark::Module waymark_module;
const waymark::Module waymark_module{waymark::kModuleVersion, &kNumber};
