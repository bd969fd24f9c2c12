#include "workbench/report/camera_report.hpp"

#include <array>
#include <cmath>

#include <nlohmann/json.hpp>

#include "workbench/logs/files.hpp"
#include "workbench/logs/json_text.hpp"
#include "workbench/report/image_text.hpp"
#include "workbench/report/pages.hpp"
#include "workbench/report/rounded.hpp"

namespace waymark {
namespace {

using Json = nlohmann::ordered_json;
using calibrate::BoardView;
using calibrate::CameraCalibration;
using calibrate::Fate;

constexpr std::size_t kMaxImages = 60;

/// As many digits as an image shows.
double in_thousandths(double px) { return std::round(1000.0 * px) / 1000.0; }

Json intrinsics_json(const CameraCalibration& calibration) {
  constexpr std::array kNames{"fu_px", "fv_px", "cu_px", "cv_px", "k1", "k2", "p1", "p2", "k3"};
  const auto values = calibrate::intrinsics_of(calibration.fit.camera);
  const auto sigma = calibration.fit.sigma();
  Json rows = Json::array();
  for (std::size_t i = 0; i < kNames.size(); ++i) {
    const auto place = static_cast<Eigen::Index>(i);
    if (place == 8 && calibration.lens == calibrate::Lens::kFourTerms) continue;
    rows.push_back({{"name", kNames[i]},
                    {"value", rounded(values[place])},
                    {"sigma", rounded(sigma[place])},
                    {"held_out_sigma", rounded(calibration.held_out.sigma[place])}});
  }
  return rows;
}

Json view_json(const BoardView& view, const calibrate::Board& board) {
  Json json{{"name", view.name}, {"verdict", name_of(view.fate)}};
  if (!view.why.empty()) json["why"] = view.why;
  if (view.edge_px > 0.0) json["edge_px"] = rounded(view.edge_px);
  if (view.fit.residuals_px.empty()) return json;
  json["rms_px"] = rounded(view.fit.rms_px());
  if (view.held_out_rms_px > 0.0 && view.fate == Fate::kUsed)
    json["held_out_rms_px"] = rounded(view.held_out_rms_px);
  json["corners"] = view.corners.size();
  json["tilt_deg"] = rounded(calibrate::tilt_deg(view.fit));
  json["distance_m"] = rounded(calibrate::distance_m(view.fit, board));
  return json;
}

/// (u, v) of a corner and of its residual.
Json corners_json(const BoardView& view) {
  Json rows = Json::array();
  for (std::size_t i = 0; i < view.fit.residuals_px.size(); ++i) {
    const Eigen::Vector2d &p = view.corners[i].pixel, &r = view.fit.residuals_px[i];
    rows.push_back(
        {in_thousandths(p.x()), in_thousandths(p.y()), in_thousandths(r.x()), in_thousandths(r.y())});
  }
  return rows;
}

Json weaknesses_json(const CameraCalibration& calibration) {
  Json rows = Json::array();
  for (const auto& weakness : calibration.weaknesses)
    rows.push_back({{"what", weakness.what}, {"advice", weakness.advice}});
  return rows;
}

Json figures_json(const CameraCalibration& calibration) {
  const auto& camera = calibration.fit.camera;
  Json json{{"board", describe(calibration.board)},
            {"width_px", camera.width_px},
            {"height_px", camera.height_px},
            {"weak", calibration.is_weak()},
            {"weaknesses", weaknesses_json(calibration)},
            {"views_used", calibration.used()},
            {"rms_px", rounded(calibration.fit.rms_px)}};
  if (calibration.held_out.folds > 0)
    json["held_out"] = {
        {"folds", calibration.held_out.folds},
        {"rms_px", rounded(calibration.held_out.rms_px)},
        {"focal_px",
         {rounded(calibration.held_out.shortest_focal_px), rounded(calibration.held_out.longest_focal_px)}}};
  json["covered"] = rounded(calibration.covered);
  json["k3_in_sigmas"] = rounded(calibration.k3_in_sigmas);
  json["intrinsics"] = intrinsics_json(calibration);
  return json;
}

/// Frames of a stream that were not kept are counted by the page, not listed.
Json shown_views_json(const CameraCalibration& calibration) {
  Json rows = Json::array();
  std::size_t images = 0;
  for (const BoardView& view : calibration.views) {
    const bool is_passed_over =
        !view.is_shown() && (view.fate == Fate::kAlike || view.fate == Fate::kNoBoard);
    if (is_passed_over) continue;
    Json row = view_json(view, calibration.board);
    row["residuals"] = corners_json(view);
    if (view.is_shown() && images++ < kMaxImages) {
      row["png"] = image_text(view.small);
      row["size"] = {view.small.width_px() * view.reduction, view.small.height_px() * view.reduction};
    }
    rows.push_back(std::move(row));
  }
  return rows;
}

Json projection_json(const CameraCalibration& calibration) {
  Json places = Json::array();
  for (const auto& place : calibration.projection)
    places.push_back({rounded(place.pixel.x()), rounded(place.pixel.y()), rounded(place.sigma_px)});
  return {
      {"columns", calibrate::kProjectionColumns}, {"rows", calibrate::kProjectionRows}, {"places", places}};
}

}  // namespace

std::string render_camera_report(const CameraReport& report) {
  Json data = figures_json(report.calibration);
  data["version"] = WAYMARK_VERSION;
  data["command"] = report.command;
  data["has_scale"] = report.calibration.board.has_scale;
  data["images"] = report.calibration.views.size();
  data["projection"] = projection_json(report.calibration);
  data["views"] = shown_views_json(report.calibration);
  return fill_page(camera_page(), json_text(data));
}

Result<void> write_camera_report(const CameraReport& report, const std::filesystem::path& path) {
  return write_file(path, render_camera_report(report));
}

std::string camera_json_text(const CameraCalibration& calibration) {
  Json json = figures_json(calibration);
  json["views"] = Json::array();
  for (const BoardView& view : calibration.views) json["views"].push_back(view_json(view, calibration.board));
  return json_text(json, 2);
}

}  // namespace waymark
