#include "workbench/datasets/survey.hpp"

#include <algorithm>
#include <vector>

#include "waymark/core/gaussian.hpp"

#include "workbench/logs/text_table.hpp"

namespace waymark {
namespace {

LandmarkId id_of(int number, const MapState& map) {
  const auto found = std::ranges::find(map.ids, number, &LandmarkId::number);
  if (found != map.ids.end()) return *found;
  return {map.ids.empty() ? LandmarkId::Family::kMarker : map.ids.front().family, number};
}

struct Surveyed {
  LandmarkId id;
  Eigen::Vector2d position_m;
  Eigen::Matrix2d covariance;
};

Surveyed read_row(TextTable& row, const MapState& map) {
  const int number = row.integer(0);
  if (number < 0) row.fail("the id of a surveyed landmark cannot be negative");
  if (row.is_empty(3) || row.is_empty(5))
    row.fail("a survey needs variances: columns id,x_m,y_m,sxx,sxy,syy");
  const double sxy = row.is_empty(4) ? 0.0 : row.number(4);
  Surveyed surveyed{id_of(number, map), {row.number(1), row.number(2)}, {}};
  surveyed.covariance << row.number(3), sxy, sxy, row.number(5);
  if (!is_covariance(surveyed.covariance)) row.fail("the covariance is not positive semi-definite");
  return surveyed;
}

}  // namespace

Result<MapState> read_survey(const std::filesystem::path& path, const MapState& map) {
  auto table = TextTable::open(
      path, {"id,x_m,y_m,sxx,sxy,syy,z_m", TableLayout::Separator::kComma, "sxx,sxy,syy,z_m"});
  if (!table) return table.error();
  std::vector<Surveyed> rows;
  while (table->next()) {
    const Surveyed row = read_row(*table, map);
    if (std::ranges::find(rows, row.id, &Surveyed::id) != rows.end()) table->fail("this id is listed twice");
    rows.push_back(row);
  }
  if (table->error()) return *table->error();
  MapState survey;
  survey.made_by = "survey " + path.filename().string();
  survey.landmarks.resize(2 * std::ssize(rows));
  survey.covariance = Eigen::MatrixXd::Zero(3 + 2 * std::ssize(rows), 3 + 2 * std::ssize(rows));
  for (Eigen::Index i = 0; i < std::ssize(rows); ++i) {
    const Surveyed& row = rows[static_cast<std::size_t>(i)];
    survey.ids.push_back(row.id);
    survey.observations.push_back(1);
    survey.landmarks.segment<2>(2 * i) = row.position_m;
    survey.covariance.block<2, 2>(3 + 2 * i, 3 + 2 * i) = row.covariance;
  }
  return survey;
}

}  // namespace waymark
