#pragma once

#include <array>
#include <string_view>

namespace waymark::log_format {

/// One CSV file of a log folder.
struct Table {
  std::string_view file;
  std::string_view columns;
  std::string_view may_lack{};  ///< columns that need not be there
};

inline constexpr Table kWheels{"wheels.csv", "stamp_s,left_rad,right_rad"};
inline constexpr Table kVelocity{"velocity.csv", "stamp_s,v_mps,w_radps"};
inline constexpr Table kSteering{"steering.csv", "stamp_s,v_mps,steer_rad"};
inline constexpr Table kOdometry{"odometry.csv", "stamp_s,x_m,y_m,theta_rad"};
/// Of a gyro, beside the odometry.
inline constexpr Table kYawRate{"imu.csv", "stamp_s,w_radps"};
inline constexpr Table kTruth{"truth.csv", "stamp_s,x_m,y_m,theta_rad", "theta_rad"};
/// A row without id and measurement says that the sensor looked and saw nothing.
inline constexpr Table kObservations{"observations.csv", "stamp_s,id,range_m,bearing_rad,u_px,v_px",
                                     "id,range_m,bearing_rad,u_px,v_px"};
inline constexpr Table kImages{"images.csv", "stamp_s,file"};
inline constexpr Table kLandmarks{"landmarks.csv", "id,x_m,y_m,z_m", "z_m"};

/// A log has at most one of these.
inline constexpr std::array kOdometryTables{kWheels, kVelocity, kSteering, kOdometry};
inline constexpr std::array kTables{kWheels, kVelocity,     kSteering, kOdometry, kYawRate,
                                    kTruth,  kObservations, kImages,   kLandmarks};

inline constexpr std::string_view kInfoFile = "log.yaml";
inline constexpr std::string_view kCameraFile = "camera.yaml";
inline constexpr std::string_view kImageFolder = "images";
inline constexpr std::string_view kVersionKey = "waymark_log";
inline constexpr std::string_view kVersion = "1";
/// Config keys of any kind stand under this section of log.yaml.
inline constexpr std::string_view kConfigSection = "config.";

/// A key of log.yaml that is a config key under another name.
struct Setting {
  std::string_view log_key;
  std::string_view config_key;
};

inline constexpr std::array kSettings{
    Setting{"wheels.left_radius_m", "wheels.left_radius_m"},
    Setting{"wheels.right_radius_m", "wheels.right_radius_m"},
    Setting{"wheels.track_m", "wheels.track_m"},
    Setting{"car.wheel_base_m", "car.wheel_base_m"},
    Setting{"car.encoder_offset_m", "car.encoder_offset_m"},
    Setting{"landmark_sensor.x_m", "sensor.x_m"},
    Setting{"landmark_sensor.y_m", "sensor.y_m"},
    Setting{"landmark_sensor.yaw_deg", "sensor.yaw_deg"},
    Setting{"camera_mount.x_m", "camera.mount_x_m"},
    Setting{"camera_mount.y_m", "camera.mount_y_m"},
    Setting{"camera_mount.z_m", "camera.mount_z_m"},
    Setting{"camera_mount.roll_deg", "camera.mount_roll_deg"},
    Setting{"camera_mount.pitch_deg", "camera.mount_pitch_deg"},
    Setting{"camera_mount.yaw_deg", "camera.mount_yaw_deg"},
    Setting{"noise.range_sigma_m", "sensor.range_sigma_m"},
    Setting{"noise.bearing_sigma_deg", "sensor.bearing_sigma_deg"},
};

}  // namespace waymark::log_format
