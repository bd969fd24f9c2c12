// A filter in a loop of your own: no log, no pipeline, no threads.
//
//   state       pose (x, y, theta) and landmarks (x, y), world frame = where the robot starts
//   motion      increment in the robot frame, 3x3 covariance
//   observation    range r and bearing b of a landmark with an identity, 2x2 covariance
//
// The robot drives a circle around one landmark and past another; its wheels believe it turns 5 % less than
// it does.

#include <cmath>
#include <cstdio>

#include <waymark/waymark.hpp>

int main() {
  using namespace waymark;

  LandmarkSensor sensor;  // looks ahead, 10 cm in front of the axle
  sensor.x_m = 0.1;
  EkfSlam filter({.capacity = 10}, sensor);

  const Eigen::Vector2d landmarks[] = {{0.0, 2.0}, {3.0, 4.0}};
  const Eigen::Matrix3d motion_noise = Eigen::Vector3d(1e-4, 1e-5, 4e-4).asDiagonal();
  const Eigen::Matrix2d observation_noise = Eigen::Vector2d(0.05 * 0.05, 0.02 * 0.02).asDiagonal();

  Pose2 T_world_robot;     // the truth
  Pose2 T_world_odometry;  // what the wheels alone say
  for (int step = 0; step < 200; ++step) {
    T_world_robot = T_world_robot * Pose2{0.1, 0.0, 0.05};
    const Motion measured{{0.1, 0.0, 0.0475}, motion_noise};
    T_world_odometry = T_world_odometry * measured.increment;
    filter.predict(measured);

    Observations scan;
    for (int number = 0; number < 2; ++number) {
      const auto z =
          RangeBearingModel::linearize(T_world_robot, sensor.T_robot_sensor(), landmarks[number]).predicted;
      scan.push_back(
          {LandmarkId{LandmarkId::Family::kMarker, number}, RangeBearing{z[0], z[1]}, observation_noise});
    }
    filter.correct(scan);
  }

  const PoseEstimate pose = filter.pose();
  const double error_m = (pose.T_world_robot.position() - T_world_robot.position()).norm();
  const double odometry_error_m = (T_world_odometry.position() - T_world_robot.position()).norm();
  std::printf("position off by %.3f m (odometry alone %.3f m), believed sigma %.3f m\n", error_m,
              odometry_error_m, std::sqrt(pose.covariance.topLeftCorner<2, 2>().trace()));
  for (const LandmarkEstimate& landmark : filter.snapshot().landmarks)
    std::printf("landmark %d at (%.2f, %.2f), seen %d times\n", landmark.id.number, landmark.position_m.x(),
                landmark.position_m.y(), landmark.observations);
  return error_m < 0.5 * odometry_error_m ? 0 : 1;
}
