#include "workbench/live/ros2_messages.hpp"

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>

namespace waymark::live::ros2 {
namespace {

static_assert(std::endian::native == std::endian::little);

constexpr std::size_t kEncapsulation = 4;

/// Numbers at multiples of their size, counted from behind the encapsulation.
class Cdr {
 public:
  template <class Number>
  Cdr& number(Number value) {
    text_.resize((text_.size() - kEncapsulation + sizeof(Number) - 1) / sizeof(Number) * sizeof(Number) +
                 kEncapsulation);
    std::array<char, sizeof(Number)> raw{};
    std::memcpy(raw.data(), &value, raw.size());
    text_.append(raw.data(), raw.size());
    return *this;
  }
  Cdr& text(std::string_view text) {
    number(static_cast<std::uint32_t>(text.size() + 1));
    text_ += text;
    text_ += '\0';
    return *this;
  }
  Cdr& bytes(std::string_view bytes) {
    number(static_cast<std::uint32_t>(bytes.size()));
    text_ += bytes;
    return *this;
  }
  Cdr& header(Stamp stamp, std::string_view frame) {
    const std::int64_t ns = stamp.since_epoch.count();
    constexpr std::int64_t kSecond = 1'000'000'000;
    return number(static_cast<std::int32_t>(ns / kSecond))
        .number(static_cast<std::uint32_t>(ns % kSecond))
        .text(frame);
  }
  [[nodiscard]] const std::string& get() const { return text_; }

 private:
  std::string text_{std::string("\0\1\0\0", kEncapsulation)};
};

}  // namespace

const char* const kCompressedImage = R"(std_msgs/Header header
string format
uint8[] data
================================================================================
MSG: std_msgs/Header
builtin_interfaces/Time stamp
string frame_id
================================================================================
MSG: builtin_interfaces/Time
int32 sec
uint32 nanosec
)";

const char* const kPoseWithCovarianceStamped = R"(std_msgs/Header header
geometry_msgs/PoseWithCovariance pose
================================================================================
MSG: std_msgs/Header
builtin_interfaces/Time stamp
string frame_id
================================================================================
MSG: builtin_interfaces/Time
int32 sec
uint32 nanosec
================================================================================
MSG: geometry_msgs/PoseWithCovariance
geometry_msgs/Pose pose
float64[36] covariance
================================================================================
MSG: geometry_msgs/Pose
geometry_msgs/Point position
geometry_msgs/Quaternion orientation
================================================================================
MSG: geometry_msgs/Point
float64 x
float64 y
float64 z
================================================================================
MSG: geometry_msgs/Quaternion
float64 x
float64 y
float64 z
float64 w
)";

std::string compressed_image(Stamp stamp, std::string_view frame, std::string_view bytes) {
  const bool is_png = bytes.starts_with("\x89PNG");
  return Cdr().header(stamp, frame).text(is_png ? "png" : "jpeg").bytes(bytes).get();
}

std::string pose_with_covariance(Stamp stamp, std::string_view frame, const PoseEstimate& pose) {
  const Pose2& T = pose.T_world_robot;
  Cdr cdr;
  cdr.header(stamp, frame).number(T.x_m).number(T.y_m).number(0.0);
  cdr.number(0.0).number(0.0).number(std::sin(0.5 * T.theta_rad)).number(std::cos(0.5 * T.theta_rad));
  constexpr std::array kPlanar{0, 1, 5};  // x, y and yaw among x, y, z, roll, pitch, yaw
  Eigen::Matrix<double, 6, 6> P = Eigen::Matrix<double, 6, 6>::Zero();
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column)
      P(kPlanar[static_cast<std::size_t>(row)], kPlanar[static_cast<std::size_t>(column)]) =
          pose.covariance(row, column);
  for (int row = 0; row < 6; ++row)
    for (int column = 0; column < 6; ++column) cdr.number(P(row, column));
  return cdr.get();
}

}  // namespace waymark::live::ros2
