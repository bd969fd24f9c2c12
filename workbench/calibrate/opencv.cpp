#include "workbench/calibrate/opencv.hpp"

#include <fmt/format.h>

#include "workbench/config/module.hpp"

namespace waymark::calibrate {

Result<const OpenCv*> load_opencv(const std::string& what) {
  const auto module = load_module("opencv", module_folders());
  if (module) return static_cast<const OpenCv*>(*module);
  return Error{fmt::format("{} needs the OpenCV module ({}): run scripts/setup.sh --opencv and build again",
                           what, module.error().message)};
}

}  // namespace waymark::calibrate
