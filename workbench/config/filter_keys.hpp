#pragma once

#include "waymark/association/association_options.hpp"
#include "waymark/association/gate.hpp"
#include "waymark/ekf/ekf_options.hpp"
#include "waymark/ekf/odometry_state_options.hpp"
#include "waymark/ekf/pixel_slam_options.hpp"
#include "waymark/fastslam/fast_slam_options.hpp"
#include "waymark/smooth/options.hpp"

#include "workbench/config/schema.hpp"

namespace waymark {

void describe(Schema& schema, GateOptions& options);
void describe(Schema& schema, AssociationOptions& options);
void describe(Schema& schema, EkfOptions& options);
void describe(Schema& schema, OdometryStateOptions& options);
void describe(Schema& schema, PixelSlamOptions& options);
void describe(Schema& schema, FastSlamOptions& options);
/// Keys smooth.*.
void describe(Schema& schema, SmoothOptions& options);

}  // namespace waymark
