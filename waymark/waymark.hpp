#pragma once

/// Everything that a program needs to run a filter in a loop of its own, or the whole pipeline, without
/// files: find_package(waymark COMPONENTS engine) and waymark::engine.

#include "waymark/association/association_options.hpp"
#include "waymark/association/gate.hpp"
#include "waymark/association/join_maps.hpp"
#include "waymark/core/angle.hpp"
#include "waymark/core/event.hpp"
#include "waymark/core/filter.hpp"
#include "waymark/core/grey_image.hpp"
#include "waymark/core/map_state.hpp"
#include "waymark/core/motion.hpp"
#include "waymark/core/observation.hpp"
#include "waymark/core/pose2.hpp"
#include "waymark/core/result.hpp"
#include "waymark/core/stamp.hpp"
#include "waymark/ekf/ekf_slam.hpp"
#include "waymark/ekf/localizer.hpp"
#include "waymark/ekf/pixel_slam.hpp"
#include "waymark/fastslam/fast_slam.hpp"
#include "waymark/models/camera.hpp"
#include "waymark/models/landmark_sensor.hpp"
#include "waymark/models/observation_models.hpp"
#include "waymark/models/observe.hpp"
#include "waymark/models/odometry.hpp"
#include "waymark/slam/corner_front_end.hpp"
#include "waymark/slam/pipeline.hpp"
