#include "workbench/report/metrics.hpp"

#include <sys/resource.h>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "workbench/logs/json_text.hpp"
#include "workbench/report/micros.hpp"
#include "workbench/report/rounded.hpp"

namespace waymark {
namespace {

using Json = nlohmann::ordered_json;

const char* name(FilterKind kind) { return kind == FilterKind::kEkf ? "ekf" : "fastslam"; }

/// The value in force, under the name that the config file has for it.
std::string setting(const Config& config, const char* key) {
  Config copy = config;
  return describe(copy).value(key);
}

void put(Json& json, const char* key, const std::optional<double>& value) {
  if (value) json[key] = rounded(*value);
}

Json blocks_json(const Metrics& metrics) {
  Json blocks = Json::array();
  for (const auto& row : metrics.blocks) {
    const double total_us = micros(row.total);
    blocks.push_back({{"name", row.name},
                      {"calls", row.calls},
                      {"mean_us", rounded(row.calls > 0 ? total_us / static_cast<double>(row.calls) : 0.0)},
                      {"per_frame_us",
                       rounded(metrics.frames > 0 ? total_us / static_cast<double>(metrics.frames) : 0.0)}});
  }
  return blocks;
}

/// When the robot slipped and was lost, in seconds since the start of the log; null: it still is.
Json losses_json(const PoseLosses& losses, Stamp start) {
  const auto since_start = [start](Stamp stamp) { return rounded(to_seconds(stamp - start)); };
  Json slips = Json::array(), lost = Json::array();
  std::size_t recoveries = 0;
  for (const Stamp stamp : losses.slips()) slips.push_back(since_start(stamp));
  for (const LostSpan& span : losses.lost()) {
    lost.push_back({since_start(span.from), span.found ? Json(since_start(*span.found)) : Json(nullptr)});
    recoveries += span.found ? 1 : 0;
  }
  return {{"slips", slips.size()}, {"slips_s", slips}, {"recoveries", recoveries}, {"lost_s", lost}};
}

Json relative_json(const std::vector<eval::RelativeError>& relative) {
  Json rows = Json::array();
  for (const auto& error : relative) {
    Json row{{"distance_m", error.distance_m}, {"count", error.count}};
    put(row, "position_rmse_m", error.position_rmse_m);
    if (error.heading_rmse_rad) row["heading_rmse_deg"] = rounded(to_degrees(*error.heading_rmse_rad));
    rows.push_back(row);
  }
  return rows;
}

Json procrustes_json(const eval::ProcrustesScore& score) {
  Json json{{"scale", rounded(score.scale)}, {"landmark_rmse_m", rounded(score.landmark_rmse_m)}};
  put(json, "position_rmse_m", score.position_rmse_m);
  return json;
}

Json path_json(const eval::PathScore& path) {
  Json json = Json::object();
  put(json, "position_rmse_m", path.position_rmse_m);
  put(json, "position_rmse_aligned_m", path.position_rmse_aligned_m);
  put(json, "heading_rmse_deg", path.heading_rmse_deg);
  put(json, "final_error_m", path.final_error_m);
  return json;
}

Json truth_json(const eval::Evaluation& e) {
  Json truth = path_json(e.path);
  if (e.map) {
    put(truth, "landmark_rmse_m", e.map->rmse_m);
    put(truth, "landmark_rmse_anchored_m", e.map->rmse_anchored_m);
    put(truth, "landmark_rmse_self_m", e.map->rmse_self_m);
    truth["landmarks_missed"] = e.map->missed;
    truth["landmarks_spurious"] = e.map->spurious;
    put(truth, "landmark_nees_per_dof", e.map->nees_per_dof);
  }
  put(truth, "nees_mean", e.nees.mean);
  put(truth, "nees_median", e.nees.median);
  put(truth, "nees_inside_95", e.nees.inside_95);
  put(truth, "odometry_position_rmse_m", e.odometry.position_rmse_m);
  put(truth, "odometry_position_rmse_aligned_m", e.odometry.position_rmse_aligned_m);
  put(truth, "odometry_final_error_m", e.odometry.final_error_m);
  put(truth, "path_m", e.path_m);
  truth["samples"] = e.pairs;
  if (e.fit) put(truth, "scale", e.fit->scale);
  if (!e.relative.empty()) truth["relative"] = relative_json(e.relative);
  if (e.procrustes) truth["procrustes"] = procrustes_json(*e.procrustes);
  return truth;
}

/// What of a score says how far two paths and maps are apart.
Json distance_json(const eval::Evaluation& e) {
  Json json = path_json(e.path);
  if (e.map) {
    put(json, "landmark_rmse_m", e.map->rmse_m);
    put(json, "landmark_rmse_self_m", e.map->rmse_self_m);
  }
  put(json, "nees_median", e.nees.median);
  return json;
}

Json smoothed_json(const SmoothedFigures& s) {
  Json json{{"cpu_s", rounded(s.cpu_s)},
            {"iterations", s.iterations},
            {"converged", s.converged},
            {"poses", s.poses},
            {"observations", s.observations}};
  json["calibration"] = Json::object();
  for (const auto& each : s.calibration) json["calibration"][each.key] = rounded(each.value);
  json["live"] = distance_json(s.live);
  json["live"].erase("nees_median");
  if (s.truth && (s.truth->pairs > 0 || s.truth->map)) json["truth"] = distance_json(*s.truth);
  return json;
}

std::string line(const std::string& what, const std::optional<double>& value, const char* unit,
                 const std::string& more = "") {
  return value ? fmt::format("  {:<30}{:>9.3f} {}{}\n", what, *value, unit, more) : std::string();
}

std::string nees_details(const eval::NeesSummary& nees) {
  if (!nees.mean || !nees.inside_95) return "";
  return fmt::format("   (mean {:.2f}, ideal 3; {:.0f} % below the 95 % limit)", *nees.mean,
                     100.0 * *nees.inside_95);
}

/// One row of the relative error over sub-paths.
std::string drift_line(const eval::RelativeError& relative) {
  const std::string heading =
      relative.heading_rmse_rad ? fmt::format("   {:.2f} deg", to_degrees(*relative.heading_rmse_rad)) : "";
  return line(fmt::format("drift over {:.0f} m", relative.distance_m), relative.position_rmse_m, "m",
              heading + fmt::format("   ({} sub-paths)", relative.count));
}

}  // namespace

double peak_rss_mb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

Metrics make_metrics(const std::string& input, const Config& config, const Recording& recording,
                     const std::optional<eval::Evaluation>& truth) {
  Metrics metrics;
  metrics.input = input;
  metrics.filter = name(config.filter);
  metrics.observe = setting(config, "observe");
  metrics.associate = setting(config, "associate");
  metrics.seed = config.seed;
  metrics.verdict = judge(gather_evidence(recording), truth ? truth->nees.mean : std::nullopt);
  metrics.losses = recording.losses;
  if (!recording.trajectory.empty()) {
    metrics.start = recording.trajectory.front().stamp;
    metrics.duration_s = to_seconds(recording.trajectory.back().stamp - metrics.start);
  }
  metrics.events = recording.counts.events;
  metrics.observations = recording.counts.observations;
  metrics.landmarks = recording.filter->snapshot().landmarks.size();
  metrics.wall_s = to_seconds(recording.wall);
  metrics.realtime_factor = metrics.wall_s > 0.0 ? metrics.duration_s / metrics.wall_s : 0.0;
  metrics.steps = step_times(recording.steps);
  metrics.blocks = recording.blocks;
  metrics.frames = recording.steps.size();
  metrics.deadline_misses = deadline_misses(recording);
  metrics.peak_rss_mb = peak_rss_mb();
  metrics.nis_per_dof = nis_per_dof(recording.innovations);
  metrics.truth = truth;
  if (const auto calibration = recording.filter->calibration())
    metrics.calibration = smooth::calibrated_keys(*calibration, config);
  return metrics;
}

std::string to_json(const Metrics& m) {
  Json json{{"input", m.input},
            {"filter", m.filter},
            {"observe", m.observe},
            {"associate", m.associate},
            {"seed", m.seed},
            {"verdict", {{"level", name_of(m.verdict.level)}, {"reasons", m.verdict.reasons}}},
            {"robot", losses_json(m.losses, m.start)},
            {"duration_s", rounded(m.duration_s)},
            {"events", m.events},
            {"observations", m.observations},
            {"landmarks", m.landmarks},
            {"wall_s", rounded(m.wall_s)},
            {"realtime_factor", rounded(m.realtime_factor)},
            {"step_us",
             {{"mean", rounded(m.steps.mean_us)},
              {"p50", rounded(m.steps.p50_us)},
              {"p99", rounded(m.steps.p99_us)},
              {"p999", rounded(m.steps.p999_us)},
              {"max", rounded(m.steps.max_us)}}},
            {"blocks", blocks_json(m)},
            {"deadline_misses", m.deadline_misses},
            {"peak_rss_mb", rounded(m.peak_rss_mb)}};
  put(json, "nis_per_dof", m.nis_per_dof);
  if (m.truth && (m.truth->pairs > 0 || m.truth->map)) json["truth"] = truth_json(*m.truth);
  for (const auto& each : m.calibration)
    json["calibration"][each.key] = {{"value", rounded(each.value)}, {"sigma", rounded(each.sigma)}};
  if (m.smoothed) json["smoothed"] = smoothed_json(*m.smoothed);
  return json_text(json, 2) + "\n";
}

SmoothedFigures smoothed_figures(const smooth::Smoothed& smoothed, const Config& config,
                                 const Recording& recording, const std::optional<eval::Evaluation>& truth) {
  std::vector<TrueLandmark> map;
  for (const auto& landmark : smoothed.landmarks) {
    const Eigen::Vector3d& p = landmark.position_m;
    map.push_back({landmark.id, p.x(), p.y(), p.z()});
  }
  const auto live = eval::evaluate(recording.trajectory, recording.filter->snapshot().landmarks,
                                   eval::TruthTrack::from_trajectory(smoothed.trajectory), map);
  return {to_seconds(smoothed.cpu),
          smoothed.iterations,
          smoothed.converged,
          smoothed.steps.size(),
          smoothed.observations,
          smooth::calibrated_keys(smoothed.calibration, config),
          live,
          truth};
}

std::string truth_json_text(const eval::Evaluation& evaluation) {
  Json json = truth_json(evaluation);
  if (!evaluation.notes.empty()) json["notes"] = evaluation.notes;
  return json_text(json, 2) + "\n";
}

std::string to_text(const eval::Evaluation& e) {
  const auto against = [](const std::optional<double>& odometry) {
    return odometry ? fmt::format("   (odometry alone {:.3f} m)", *odometry) : std::string();
  };
  std::string text =
      line("position RMSE, from start", e.path.position_rmse_m, "m", against(e.odometry.position_rmse_m));
  text += line("position RMSE, aligned", e.path.position_rmse_aligned_m, "m",
               against(e.odometry.position_rmse_aligned_m));
  text += line("heading RMSE", e.path.heading_rmse_deg, "deg");
  text += line("final error", e.path.final_error_m, "m", against(e.odometry.final_error_m));
  if (e.map) {
    text += line("landmark RMSE, with the path", e.map->rmse_m, "m");
    text += line("landmark RMSE, by themselves", e.map->rmse_self_m, "m");
  }
  text += line("pose NEES, median (ideal 2.4)", e.nees.median, "", nees_details(e.nees));
  if (e.map) text += line("landmark NEES per dof (ideal 1)", e.map->nees_per_dof, "");
  for (const auto& relative : e.relative) text += drift_line(relative);
  if (e.procrustes)
    text += line("Procrustes on landmarks, path", e.procrustes->position_rmse_m, "m",
                 fmt::format("   (scale {:.4f}, landmarks {:.3f} m; misleading, see docs/evaluation.md)",
                             e.procrustes->scale, e.procrustes->landmark_rmse_m));
  for (const auto& note : e.notes) text += fmt::format("  note: {}\n", note);
  return text;
}

static std::string to_text(const std::vector<smooth::CalibratedKey>& calibration) {
  std::string text;
  for (const auto& [key, value, sigma, is_unobservable] : calibration)
    text += fmt::format("  {:<30}{:>9.4f} +- {:.4f}{}\n", key, value, sigma,
                        is_unobservable ? "   (prior: not observable in this log)" : "");
  return text;
}

static std::string to_text(const SmoothedFigures& s) {
  std::string text = fmt::format("smoothed: {} poses and {} observations in {:.2f} s{}\n", s.poses,
                                 s.observations, s.cpu_s, s.converged ? "" : ", not converged");
  if (s.truth) {
    text += line("position RMSE, from start", s.truth->path.position_rmse_m, "m");
    text += line("position RMSE, aligned", s.truth->path.position_rmse_aligned_m, "m");
    if (s.truth->map) text += line("landmark RMSE, with the path", s.truth->map->rmse_m, "m");
  }
  text += line("causal path vs smoothed, aligned", s.live.path.position_rmse_aligned_m, "m");
  return text + to_text(s.calibration);
}

static std::string to_text(const Verdict& verdict) {
  std::string text = fmt::format("verdict: {}\n", name_of(verdict.level));
  for (const std::string& reason : verdict.reasons) text += fmt::format("  {}\n", reason);
  return text;
}

std::string to_text(const Metrics& m) {
  std::string text = to_text(m.verdict);
  text += fmt::format("{}: {:.0f} s of log in {:.2f} s ({:.0f}x real time), {} observations, {} landmarks\n",
                      m.filter, m.duration_s, m.wall_s, m.realtime_factor, m.observations, m.landmarks);
  if (m.truth) text += to_text(*m.truth);
  text += line("NIS per dof (ideal 1)", m.nis_per_dof, "");
  text += line("step, median", m.steps.p50_us, "us", fmt::format("   (99 %: {:.1f} us)", m.steps.p99_us));
  text += to_text(m.calibration);
  if (m.smoothed) text += to_text(*m.smoothed);
  return text;
}

}  // namespace waymark
