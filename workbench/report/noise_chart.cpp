#include "workbench/report/noise_chart.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "waymark/core/angle.hpp"

#include "workbench/logs/json_text.hpp"
#include "workbench/report/rounded.hpp"

namespace waymark {

using Json = nlohmann::ordered_json;

std::string noise_chart_json(const NoiseAxes& axes, const std::vector<calibrate::NoiseBin>& bins) {
  Json points = Json::array();
  for (const calibrate::NoiseBin& bin : bins)
    points.push_back({{"at", rounded(axes.x_unit * bin.at)},
                      {"mean", rounded(axes.y_unit * bin.mean)},
                      {"sigma", rounded(axes.y_unit * bin.sigma.value)},
                      {"count", bin.count}});
  return json_text(
      Json{{"title", axes.title}, {"note", axes.note}, {"x", axes.x}, {"y", axes.y}, {"points", points}});
}

std::string noise_charts_json(const std::vector<calibrate::NoiseBin>& ranges,
                              const std::vector<calibrate::NoiseBin>& bearings) {
  const NoiseAxes by_range{"Error of the range (m)", "By range (m)", "range, m", "m"};
  const double deg = to_degrees(1.0);
  const NoiseAxes by_bearing{
      "Error of the bearing (°)", "By bearing (°), left is positive", "bearing, °", "°", deg, deg};
  return fmt::format("[{},{}]", noise_chart_json(by_range, ranges), noise_chart_json(by_bearing, bearings));
}

}  // namespace waymark
