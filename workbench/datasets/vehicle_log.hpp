#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "waymark/core/event.hpp"
#include "waymark/core/result.hpp"

#include "workbench/datasets/mat_file.hpp"
#include "workbench/logs/source.hpp"

namespace waymark {

/// Where the laser and, over it, the antenna of the satellite receiver stand on the utility vehicle of the
/// University of Sydney, m ahead and left of the middle of its rear axle.
inline const Eigen::Vector2d kVehicleLaser_m(3.78, 0.50);

/// What the logs of that vehicle have in common: known_settings() of the name `settings`, no identities, and
/// a truth that is of the antenna.
[[nodiscard]] Result<LogInfo> vehicle_info(std::string name, std::string format, std::string_view settings);

/// Times that never go back, one per row. `unit_s`: 1e-3 where they are in milliseconds.
[[nodiscard]] Result<std::vector<Stamp>> read_stamps(const MatFile& file, std::string_view variable,
                                                     double unit_s);

/// The variables have as many rows each.
[[nodiscard]] Result<void> check_rows(const MatFile& file, std::string_view variable, Eigen::Index rows,
                                      std::size_t expected);

/// Speeds in m/s and steering angles in rad, left positive, one per stamp.
void add_steering(const std::vector<Stamp>& stamps, const Eigen::VectorXd& v_mps,
                  const Eigen::VectorXd& steer_rad, std::vector<Event>& events);

/// A position by satellites.
struct Fix {
  Stamp stamp;
  Eigen::Vector2d position_m = Eigen::Vector2d::Zero();  ///< east, north
};

/// The variables of a receiver's log: times, east and north in m.
[[nodiscard]] Result<std::vector<Fix>> read_fixes(const MatFile& file, std::string_view times, double unit_s,
                                                  std::string_view east, std::string_view north);

/// Those of `fixes`, in order of time, that can be believed: each neighbour is at most 1.5 s away, and to get
/// there from it takes less than 15 m/s.
[[nodiscard]] std::vector<Fix> clean_fixes(const std::vector<Fix>& fixes);

/// Truth without heading.
void add_truth(const std::vector<Fix>& fixes, std::vector<Event>& events);

}  // namespace waymark
