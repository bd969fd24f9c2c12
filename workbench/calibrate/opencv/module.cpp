// What waymark-opencv.so offers to who loads it.

#include "workbench/config/module.hpp"

#include "workbench/calibrate/opencv.hpp"
#include "workbench/calibrate/opencv/board_finders.hpp"
#include "workbench/calibrate/opencv/video.hpp"
#include "workbench/config/module_version.hpp"

namespace {

constexpr waymark::calibrate::OpenCv kFunctions{
    waymark::calibrate::opencv::make_chessboard_finder, waymark::calibrate::opencv::make_charuco_finder,
    waymark::calibrate::opencv::guess_chessboard, waymark::calibrate::opencv::open_video};

}  // namespace

extern "C" __attribute__((visibility("default"))) const waymark::Module waymark_module;
const waymark::Module waymark_module{waymark::kModuleVersion, &kFunctions};
