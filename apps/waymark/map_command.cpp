#include <cmath>
#include <cstdio>
#include <memory>

#include <fmt/format.h>

#include "waymark/association/join_maps.hpp"
#include "waymark/core/angle.hpp"

#include "commands.hpp"
#include "workbench/datasets/survey.hpp"
#include "workbench/logs/map_files.hpp"
#include "workbench/logs/map_forms.hpp"

namespace waymark::app {
namespace {

struct MapRequest {
  std::string input;
  std::string other;
  std::string output;
};

Result<void> show(const MapRequest& request) {
  const auto map = read_map_of_any_form(request.input);
  if (!map) return map.error();
  const Snapshot snapshot = snapshot_of(*map);
  const Eigen::Vector3d sigma = snapshot.pose.covariance.diagonal().cwiseSqrt();
  const Pose2& pose = map->T_world_robot;
  fmt::print("{}\n  made by {}\n  at {} s\n", request.input, map->made_by, to_string(map->stamp));
  fmt::print("  robot at x {:.3f} m, y {:.3f} m, heading {:.1f} deg; sigma {:.3f} m, {:.3f} m, {:.2f} deg\n",
             pose.x_m, pose.y_m, to_degrees(pose.theta_rad), sigma.x(), sigma.y(), to_degrees(sigma.z()));
  fmt::print("  {} landmarks of dimension {}\n", map->ids.size(), map->landmark_dimension);
  fmt::print("  {:<8} {:>8} {:>10} {:>10} {:>10} {:>9} {:>10}\n", "kind", "number", "x_m", "y_m", "z_m",
             "sigma_m", "observations");
  for (const LandmarkEstimate& landmark : snapshot.landmarks)
    fmt::print("  {:<8} {:>8} {:>10.3f} {:>10.3f} {:>10.3f} {:>9.4f} {:>10}\n",
               family_name(landmark.id.family), landmark.id.number, landmark.position_m.x(),
               landmark.position_m.y(), landmark.position_m.z(), std::sqrt(landmark.covariance.trace()),
               landmark.observations);
  return {};
}

Result<void> convert(const MapRequest& request) {
  const auto map = read_map_of_any_form(request.input);
  if (!map) return map.error();
  return write_map_of_any_form(request.output, *map);
}

Result<void> write_joined(Result<JoinedMap> joined, const std::string& output, const std::string& made_by) {
  if (!joined) return joined.error();
  joined->map.made_by = made_by;
  const Pose2& T = joined->T_first_second;
  fmt::print("{} landmarks in common, chi-square {:.1f} with {} degrees of freedom\n", joined->common,
             joined->d2, joined->dof);
  fmt::print("frame moved by x {:.3f} m, y {:.3f} m, {:.2f} deg; {} landmarks in {}\n", T.x_m, T.y_m,
             to_degrees(T.theta_rad), joined->map.ids.size(), output);
  return write_map_of_any_form(output, joined->map);
}

Result<void> merge(const MapRequest& request) {
  const auto first = read_map_of_any_form(request.input);
  if (!first) return first.error();
  const auto second = read_map_of_any_form(request.other);
  if (!second) return second.error();
  return write_joined(join_maps(*first, *second, PoseOf::kFirst), request.output,
                      fmt::format("waymark map merge of {} and {}", request.input, request.other));
}

Result<void> fix(const MapRequest& request) {
  const auto map = read_map_of_any_form(request.input);
  if (!map) return map.error();
  const auto survey = read_survey(request.other, *map);
  if (!survey) return survey.error();
  return write_joined(join_maps(*survey, *map, PoseOf::kSecond), request.output,
                      fmt::format("waymark map fix of {} by {}", request.input, request.other));
}

/// A command of `map` that reads `input` and does `act`.
CLI::App* add(CLI::App& map, Work& work, const char* name, const char* help, const char* example,
              Result<void> (*act)(const MapRequest&), const std::shared_ptr<MapRequest>& request) {
  auto* command = map.add_subcommand(name, help);
  command->add_option("map", request->input, "saved map: .waymark, .json or .csv")
      ->required()
      ->type_name("MAP");
  command->footer(std::string("Example:\n  ") + example);
  command->callback([&work, request, act] { work = [request, act] { return act(*request); }; });
  return command;
}

void add_output(CLI::App& command, MapRequest& request) {
  command.add_option("-o,--output", request.output, "map file to write: .waymark, .json or .csv")
      ->required()
      ->type_name("OUT");
}

}  // namespace

void add_map(CLI::App& app, Work& work) {
  auto* map = app.add_subcommand("map", "Show, convert, merge or correct saved maps");
  map->require_subcommand(1);
  map->footer(
      "Examples:\n  waymark map show out/map.waymark\n"
      "  waymark map merge monday/map.waymark tuesday/map.waymark -o both.waymark");
  const auto request = std::make_shared<MapRequest>();
  add(*map, work, "show", "Print robot pose, landmarks and standard deviations of a map",
      "waymark map show out/map.waymark", show, request);
  auto* to = add(*map, work, "convert", "Convert a map to another format; .csv keeps no correlations",
                 "waymark map convert out/map.waymark -o map.json", convert, request);
  add_output(*to, *request);
  auto* both =
      add(*map, work, "merge", "Merge two independent maps by the landmark identities that they share",
          "waymark map merge a.waymark b.waymark -o both.waymark", merge, request);
  both->add_option("other", request->other, "second map, in any frame")->required()->type_name("SECOND_MAP");
  add_output(*both, *request);
  auto* fixed =
      add(*map, work, "fix", "Transform a map into the frame of surveyed landmarks and correct it by them",
          "waymark map fix out/map.waymark --survey survey.csv -o fixed.waymark", fix, request);
  fixed
      ->add_option("--survey", request->other,
                   "table id,x_m,y_m,sxx,sxy,syy of at least two surveyed landmarks")
      ->required()
      ->type_name("CSV");
  add_output(*fixed, *request);
}

}  // namespace waymark::app
