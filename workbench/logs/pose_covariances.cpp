#include "workbench/logs/pose_covariances.hpp"

#include <array>
#include <string>
#include <utility>

#include "waymark/core/gaussian.hpp"

#include "workbench/logs/files.hpp"
#include "workbench/logs/number_text.hpp"
#include "workbench/logs/text_table.hpp"
#include "workbench/logs/upper_triangle.hpp"

namespace waymark {
namespace {

constexpr std::string_view kColumns = "stamp_s,sxx,sxy,sxt,syy,syt,stt";

Eigen::Matrix3d read_covariance(TextTable& row) {
  Eigen::Matrix3d P;
  std::size_t column = 1;
  for (const auto& [i, j] : kUpperTriangle) P(i, j) = P(j, i) = row.number(column++);
  if (!is_covariance(P)) row.fail("the covariance is not positive semi-definite");
  return P;
}

}  // namespace

Result<void> write_pose_covariances(const std::filesystem::path& path, const Trajectory& trajectory) {
  std::string text = std::string(kColumns) + "\n";
  for (const auto& point : trajectory) {
    if (!point.covariance) continue;
    append_stamp(text, point.stamp);
    for (const auto& [i, j] : kUpperTriangle) append_shortest(text += ',', (*point.covariance)(i, j));
    text += '\n';
  }
  return write_file(path, text);
}

Result<void> read_pose_covariances(const std::filesystem::path& path, Trajectory& trajectory) {
  auto table = TextTable::open(path, {std::string(kColumns), TableLayout::Separator::kComma, ""});
  if (!table) return table.error();
  std::size_t next = 0;
  while (table->next()) {
    const Stamp stamp = table->ordered_stamp(0);
    const Eigen::Matrix3d P = read_covariance(*table);
    while (next < trajectory.size() && trajectory[next].stamp < stamp) ++next;
    if (next == trajectory.size() || trajectory[next].stamp != stamp)
      table->fail("no pose of the trajectory has this stamp; both files must be from the same run");
    else
      trajectory[next++].covariance = P;
  }
  if (table->error()) return *table->error();
  return {};
}

}  // namespace waymark
