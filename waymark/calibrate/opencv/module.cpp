// What waymark-opencv.so offers to who loads it.

#include "waymark/core/module.hpp"

#include "waymark/calibrate/opencv.hpp"
#include "waymark/calibrate/opencv/board_finders.hpp"
#include "waymark/calibrate/opencv/video.hpp"
#include "waymark/core/module_version.hpp"

namespace {

constexpr waymark::calibrate::OpenCv kFunctions{
    waymark::calibrate::opencv::make_chessboard_finder, waymark::calibrate::opencv::make_charuco_finder,
    waymark::calibrate::opencv::guess_chessboard, waymark::calibrate::opencv::open_video};

}  // namespace

extern "C" __attribute__((visibility("default"))) const waymark::Module waymark_module;
const waymark::Module waymark_module{waymark::kModuleVersion, &kFunctions};
