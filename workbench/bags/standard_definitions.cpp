#include <algorithm>
#include <array>

#include "workbench/bags/message_definition.hpp"

namespace waymark::bag {
namespace {

struct StandardType {
  std::string_view type;
  std::string_view text;
};

/// The fields of ROS 2's interfaces in the order in which they are written to the wire.
constexpr std::array kStandardTypes{
    StandardType{"builtin_interfaces/Time", "int32 sec\nuint32 nanosec\n"},
    StandardType{"builtin_interfaces/Duration", "int32 sec\nuint32 nanosec\n"},
    StandardType{"std_msgs/Header", "builtin_interfaces/Time stamp\nstring frame_id\n"},
    StandardType{"geometry_msgs/Point", "float64 x\nfloat64 y\nfloat64 z\n"},
    StandardType{"geometry_msgs/Vector3", "float64 x\nfloat64 y\nfloat64 z\n"},
    StandardType{"geometry_msgs/Quaternion", "float64 x\nfloat64 y\nfloat64 z\nfloat64 w\n"},
    StandardType{"geometry_msgs/Pose", "Point position\nQuaternion orientation\n"},
    StandardType{"geometry_msgs/PoseStamped", "std_msgs/Header header\nPose pose\n"},
    StandardType{"geometry_msgs/PoseWithCovariance", "Pose pose\nfloat64[36] covariance\n"},
    StandardType{"geometry_msgs/PoseWithCovarianceStamped",
                 "std_msgs/Header header\nPoseWithCovariance pose\n"},
    StandardType{"geometry_msgs/Twist", "Vector3 linear\nVector3 angular\n"},
    StandardType{"geometry_msgs/TwistStamped", "std_msgs/Header header\nTwist twist\n"},
    StandardType{"geometry_msgs/TwistWithCovariance", "Twist twist\nfloat64[36] covariance\n"},
    StandardType{"geometry_msgs/Transform", "Vector3 translation\nQuaternion rotation\n"},
    StandardType{"geometry_msgs/TransformStamped",
                 "std_msgs/Header header\nstring child_frame_id\nTransform transform\n"},
    StandardType{"tf2_msgs/TFMessage", "geometry_msgs/TransformStamped[] transforms\n"},
    StandardType{"nav_msgs/Odometry",
                 "std_msgs/Header header\nstring child_frame_id\ngeometry_msgs/PoseWithCovariance pose\n"
                 "geometry_msgs/TwistWithCovariance twist\n"},
    StandardType{
        "sensor_msgs/JointState",
        "std_msgs/Header header\nstring[] name\nfloat64[] position\nfloat64[] velocity\nfloat64[] effort\n"},
    StandardType{"sensor_msgs/Imu",
                 "std_msgs/Header header\ngeometry_msgs/Quaternion orientation\n"
                 "float64[9] orientation_covariance\ngeometry_msgs/Vector3 angular_velocity\n"
                 "float64[9] angular_velocity_covariance\ngeometry_msgs/Vector3 linear_acceleration\n"
                 "float64[9] linear_acceleration_covariance\n"},
    StandardType{"sensor_msgs/Image",
                 "std_msgs/Header header\nuint32 height\nuint32 width\nstring encoding\nuint8 is_bigendian\n"
                 "uint32 step\nuint8[] data\n"},
    StandardType{"sensor_msgs/CompressedImage", "std_msgs/Header header\nstring format\nuint8[] data\n"},
    StandardType{"sensor_msgs/RegionOfInterest",
                 "uint32 x_offset\nuint32 y_offset\nuint32 height\nuint32 width\nbool do_rectify\n"},
    StandardType{"sensor_msgs/CameraInfo",
                 "std_msgs/Header header\nuint32 height\nuint32 width\nstring distortion_model\nfloat64[] d\n"
                 "float64[9] k\nfloat64[9] r\nfloat64[12] p\nuint32 binning_x\nuint32 binning_y\n"
                 "RegionOfInterest roi\n"},
    StandardType{
        "aruco_msgs/Marker",
        "std_msgs/Header header\nuint32 id\ngeometry_msgs/PoseWithCovariance pose\nfloat64 confidence\n"},
    StandardType{"aruco_msgs/MarkerArray", "std_msgs/Header header\nMarker[] markers\n"},
    StandardType{"aruco_opencv_msgs/MarkerPose", "uint16 marker_id\ngeometry_msgs/Pose pose\n"},
    StandardType{"aruco_opencv_msgs/BoardPose", "string board_name\ngeometry_msgs/Pose pose\n"},
    StandardType{"aruco_opencv_msgs/ArucoDetection",
                 "std_msgs/Header header\nMarkerPose[] markers\nBoardPose[] boards\n"},
    StandardType{"apriltag_msgs/Point", "float64 x\nfloat64 y\n"},
    StandardType{
        "apriltag_msgs/AprilTagDetection",
        "string family\nint32 id\nint32 hamming\nfloat32 goodness\nfloat32 decision_margin\nPoint centre\n"
        "Point[4] corners\nfloat64[9] homography\n"},
    StandardType{"apriltag_msgs/AprilTagDetectionArray",
                 "std_msgs/Header header\nAprilTagDetection[] detections\n"},
    StandardType{"ros2_aruco_interfaces/ArucoMarkers",
                 "std_msgs/Header header\nint64[] marker_ids\ngeometry_msgs/Pose[] poses\n"},
};

}  // namespace

std::string_view standard_definition(std::string_view type) {
  const auto found = std::ranges::find(kStandardTypes, type, &StandardType::type);
  return found == kStandardTypes.end() ? std::string_view{} : found->text;
}

}  // namespace waymark::bag
