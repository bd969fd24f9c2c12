#include <array>

#include "workbench/bags/message_definition.hpp"

namespace waymark::bag {
namespace {

struct StandardType {
  std::string_view type;
  std::string_view text;
};

/// ROS 1 numbers its headers.
constexpr std::string_view kRos1Header = "uint32 seq\ntime stamp\nstring frame_id\n";

/// The fields of interfaces in the order in which they are written to the wire, which is that of ROS 2 and,
/// but for the header, that of ROS 1. A type whose fields have changed stands here once for each version, the
/// most common one first; a version with parts of its own brings them along.
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
    StandardType{"sensor_msgs/PointField", "string name\nuint32 offset\nuint8 datatype\nuint32 count\n"},
    StandardType{
        "sensor_msgs/PointCloud2",
        "std_msgs/Header header\nuint32 height\nuint32 width\nPointField[] fields\nbool is_bigendian\n"
        "uint32 point_step\nuint32 row_step\nuint8[] data\nbool is_dense\n"},

    StandardType{"fiducial_msgs/FiducialTransform",
                 "int32 fiducial_id\ngeometry_msgs/Transform transform\nfloat64 image_error\n"
                 "float64 object_error\nfloat64 fiducial_area\n"},
    StandardType{"fiducial_msgs/FiducialTransformArray",
                 "std_msgs/Header header\nint32 image_seq\nFiducialTransform[] transforms\n"},
    StandardType{"fiducial_msgs/Fiducial",
                 "int32 fiducial_id\nint32 direction\nfloat64 x0\nfloat64 y0\nfloat64 x1\nfloat64 y1\n"
                 "float64 x2\nfloat64 y2\nfloat64 x3\nfloat64 y3\n"},
    StandardType{"fiducial_msgs/FiducialArray",
                 "std_msgs/Header header\nint32 image_seq\nFiducial[] fiducials\n"},
    StandardType{
        "aruco_msgs/Marker",
        "std_msgs/Header header\nuint32 id\ngeometry_msgs/PoseWithCovariance pose\nfloat64 confidence\n"},
    StandardType{"aruco_msgs/MarkerArray", "std_msgs/Header header\nMarker[] markers\n"},
    StandardType{"aruco_opencv_msgs/MarkerPose", "uint16 marker_id\ngeometry_msgs/Pose pose\n"},
    StandardType{"aruco_opencv_msgs/BoardPose", "string board_name\ngeometry_msgs/Pose pose\n"},
    StandardType{"aruco_opencv_msgs/ArucoDetection",
                 "std_msgs/Header header\nMarkerPose[] markers\nBoardPose[] boards\n"},
    StandardType{"ros2_aruco_interfaces/ArucoMarkers",
                 "std_msgs/Header header\nint64[] marker_ids\ngeometry_msgs/Pose[] poses\n"},
    StandardType{"ar_track_alvar_msgs/AlvarMarker",
                 "std_msgs/Header header\nuint32 id\nuint32 confidence\ngeometry_msgs/PoseStamped pose\n"},
    StandardType{"ar_track_alvar_msgs/AlvarMarkers", "std_msgs/Header header\nAlvarMarker[] markers\n"},
    StandardType{"ar_track_alvar_msgs/AlvarMarkers",
                 "std_msgs/Header header\nAlvarMarker[] markers\n"
                 "========\nMSG: ar_track_alvar_msgs/AlvarMarker\n"
                 "std_msgs/Header header\nuint32 id\nstring str\nuint32 confidence\n"
                 "geometry_msgs/PoseStamped pose\n"},

    StandardType{"apriltag_ros/AprilTagDetection",
                 "int32[] id\nfloat64[] size\ngeometry_msgs/PoseWithCovarianceStamped pose\n"},
    StandardType{"apriltag_ros/AprilTagDetectionArray",
                 "std_msgs/Header header\nAprilTagDetection[] detections\n"},
    StandardType{"apriltag_ros/AprilTagDetectionArray",
                 "std_msgs/Header header\nAprilTagDetection[] detections\n"
                 "========\nMSG: apriltag_ros/AprilTagDetection\n"
                 "int32[] id\nfloat64[] size\ngeometry_msgs/PoseWithCovarianceStamped pose\n"
                 "int32[2] pix_tl\nint32[2] pix_tr\nint32[2] pix_br\nint32[2] pix_bl\n"},
    StandardType{"apriltags2_ros/AprilTagDetection",
                 "int32[] id\nfloat64[] size\ngeometry_msgs/PoseWithCovarianceStamped pose\n"},
    StandardType{"apriltags2_ros/AprilTagDetectionArray",
                 "std_msgs/Header header\nAprilTagDetection[] detections\n"},
    StandardType{"apriltags_ros/AprilTagDetection",
                 "int32 id\nfloat64 size\ngeometry_msgs/PoseStamped pose\n"},
    StandardType{"apriltags_ros/AprilTagDetectionArray", "AprilTagDetection[] detections\n"},
    StandardType{"apriltags_ros/AprilTagDetectionArray",
                 "std_msgs/Header header\nAprilTagDetection[] detections\n"},
    StandardType{"isaac_ros_apriltag_interfaces/AprilTagDetection",
                 "string family\nint32 id\ngeometry_msgs/Point center\ngeometry_msgs/Point[4] corners\n"
                 "geometry_msgs/PoseWithCovarianceStamped pose\n"},
    StandardType{"isaac_ros_apriltag_interfaces/AprilTagDetectionArray",
                 "std_msgs/Header header\nAprilTagDetection[] detections\n"},
    StandardType{"apriltag_msgs/Point", "float64 x\nfloat64 y\n"},
    // Older versions have float64[2] centre and float64[8] corners: the same bytes.
    StandardType{
        "apriltag_msgs/AprilTagDetection",
        "string family\nint32 id\nint32 hamming\nfloat32 goodness\nfloat32 decision_margin\nPoint centre\n"
        "Point[4] corners\nfloat64[9] homography\n"},
    StandardType{"apriltag_msgs/AprilTagDetectionArray",
                 "std_msgs/Header header\nAprilTagDetection[] detections\n"},

    StandardType{"landmark_msgs/Landmark",
                 "int32 id\nint32 hamming\nfloat32 goodness\nfloat32 decision_margin\nfloat32 range\n"
                 "float32 bearing\n"},
    StandardType{"landmark_msgs/LandmarkArray", "std_msgs/Header header\nLandmark[] landmarks\n"},
    StandardType{"cartographer_ros_msgs/LandmarkEntry",
                 "string id\ngeometry_msgs/Pose tracking_from_landmark_transform\n"
                 "float64 translation_weight\nfloat64 rotation_weight\n"},
    // Older versions name the list in the singular: the same bytes.
    StandardType{"cartographer_ros_msgs/LandmarkList", "std_msgs/Header header\nLandmarkEntry[] landmarks\n"},
    StandardType{"vision_msgs/ObjectHypothesis", "string class_id\nfloat64 score\n"},
    StandardType{"vision_msgs/ObjectHypothesisWithPose",
                 "ObjectHypothesis hypothesis\ngeometry_msgs/PoseWithCovariance pose\n"},
    StandardType{"vision_msgs/BoundingBox3D", "geometry_msgs/Pose center\ngeometry_msgs/Vector3 size\n"},
    StandardType{
        "vision_msgs/Detection3D",
        "std_msgs/Header header\nObjectHypothesisWithPose[] results\nBoundingBox3D bbox\nstring id\n"},
    StandardType{"vision_msgs/Detection3DArray", "std_msgs/Header header\nDetection3D[] detections\n"},
    // ROS 2 until Foxy, and ROS 1.
    StandardType{"vision_msgs/Detection3DArray",
                 "std_msgs/Header header\nDetection3D[] detections\n"
                 "========\nMSG: vision_msgs/Detection3D\n"
                 "std_msgs/Header header\nObjectHypothesisWithPose[] results\nBoundingBox3D bbox\n"
                 "sensor_msgs/PointCloud2 source_cloud\nbool is_tracking\nstring tracking_id\n"
                 "========\nMSG: vision_msgs/ObjectHypothesisWithPose\n"
                 "string id\nfloat64 score\ngeometry_msgs/PoseWithCovariance pose\n"},
    StandardType{"vision_msgs/Detection3DArray",
                 "std_msgs/Header header\nDetection3D[] detections\n"
                 "========\nMSG: vision_msgs/Detection3D\n"
                 "std_msgs/Header header\nObjectHypothesisWithPose[] results\nBoundingBox3D bbox\n"
                 "sensor_msgs/PointCloud2 source_cloud\n"
                 "========\nMSG: vision_msgs/ObjectHypothesisWithPose\n"
                 "int64 id\nfloat64 score\ngeometry_msgs/PoseWithCovariance pose\n"},
};

}  // namespace

std::vector<std::string_view> known_definitions(std::string_view type, Encoding encoding) {
  if (type == "std_msgs/Header" && encoding == Encoding::kRos1) return {kRos1Header};
  std::vector<std::string_view> texts;
  for (const StandardType& standard : kStandardTypes)
    if (standard.type == type) texts.push_back(standard.text);
  return texts;
}

}  // namespace waymark::bag
