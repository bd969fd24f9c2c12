#pragma once

#include "waymark/models/camera.hpp"
#include "waymark/models/landmark_sensor.hpp"
#include "waymark/models/odometry.hpp"
#include "waymark/slam/pipeline_options.hpp"

#include "workbench/config/schema.hpp"

namespace waymark {

void describe(Schema& schema, OdometryOptions& options);
void describe(Schema& schema, LandmarkSensor& sensor);
void describe(Schema& schema, CameraOptions& options);
void describe(Schema& schema, PipelineOptions& options);

}  // namespace waymark
