#pragma once

namespace waymark {

/// What a module and who loads it must agree on, since C++ types cross the seam. The build defines
/// WAYMARK_VERSION for the sources that include this.
inline constexpr const char* kModuleVersion = "Waymark " WAYMARK_VERSION ", compiler " __VERSION__;

}  // namespace waymark
