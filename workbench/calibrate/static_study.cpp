#include "workbench/calibrate/static_study.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include <Eigen/LU>
#include <fmt/format.h>

#include "waymark/core/angle.hpp"

#include "workbench/logs/text_table.hpp"
#include "workbench/run/make_filter.hpp"

namespace waymark::calibrate {
namespace {

namespace fs = std::filesystem;

/// Observations of one landmark in one recording.
using LandmarkObservations = std::vector<RangeBearing>;

/// What one recording shows, by landmark.
struct Shown {
  int scans = 0;
  std::map<std::optional<LandmarkId>, LandmarkObservations> landmarks;
};

/// Reads a recording's observations, given or found in images.
class Reader {
 public:
  Reader(const Config& config, FrontEnd* markers) : sensor_(config.sensor), markers_(markers) {}

  void take(const EventContent& content) {
    if (const auto* observations = std::get_if<Observations>(&content)) return add(*observations, true);
    if (markers_ == nullptr) return;
    if (const auto* outlines = std::get_if<MarkerOutlines>(&content))
      return add(markers_->see(*outlines), false);
    const auto* image = std::get_if<Image>(&content);
    if (image == nullptr || !image->pixels || !markers_->fits(*image->pixels)) return;
    markers_->announce(image->pixels);
    add(std::get<std::span<const Observation>>(markers_->see(image->pixels)), false);
  }

  [[nodiscard]] Shown result() && { return std::move(shown_); }

 private:
  void add(std::span<const Observation> observations, bool as_reported) {
    ++shown_.scans;
    for (const Observation& each : observations) {
      const Measurement value = as_reported ? rectify(sensor_, each.value) : each.value;
      const auto* seen = std::get_if<RangeBearing>(&value);
      if (seen != nullptr && std::isfinite(seen->range_m) && std::isfinite(seen->bearing_rad))
        shown_.landmarks[each.id].push_back(*seen);
    }
  }

  LandmarkSensor sensor_;
  FrontEnd* markers_;
  Shown shown_;
};

Result<Shown> read_recording(OpenedInput& opened) {
  auto markers = make_marker_front_end(opened.config);
  if (!markers) return markers.error();
  if (*markers && !opened.config.camera_known)
    return Error{
        "camera.fu_px: the camera is not calibrated: put the camera.yaml that `waymark calibrate camera` "
        "writes into the log, or set input.camera_file to it"};
  Reader reader(opened.config, markers->get());
  while (true) {
    auto event = opened.source->next();
    if (!event) return event.error();
    if (!*event) return std::move(reader).result();
    reader.take((*event)->content);
  }
}

/// Those of the landmark that the table means.
Result<LandmarkObservations> observations_of(const StaticPlace& place, const Shown& shown) {
  constexpr std::size_t kStray = 10;  // one in so many
  if (place.id) {
    const auto found = std::ranges::find_if(
        shown.landmarks, [&](const auto& each) { return each.first && each.first->number == *place.id; });
    return found == shown.landmarks.end() ? LandmarkObservations{} : found->second;
  }
  std::vector<const LandmarkObservations*> all;
  for (const auto& [id, landmark_observations] : shown.landmarks) all.push_back(&landmark_observations);
  std::ranges::sort(all, std::greater{}, [](const LandmarkObservations* each) { return each->size(); });
  if (all.size() > 1 && kStray * all[1]->size() > all[0]->size())
    return Error{fmt::format(
        "{}: {} landmarks are observed; add a column id with that of the landmark at the known place",
        place.log, all.size())};
  return all.empty() ? LandmarkObservations{} : *all[0];
}

PlaceStudy study_of(const StaticPlace& place, int scans, const LandmarkObservations& landmark_observations) {
  PlaceStudy study{
      .place = place, .scans = scans, .observations = static_cast<int>(landmark_observations.size())};
  const auto n = static_cast<double>(landmark_observations.size());
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  std::vector<Eigen::Vector2d> errors;
  for (const RangeBearing& z : landmark_observations) {
    errors.emplace_back(z.range_m - place.range_m, wrap_angle(z.bearing_rad - place.bearing_rad));
    mean += errors.back() / n;
  }
  for (const Eigen::Vector2d& error : errors)
    if (errors.size() > 1) study.covariance += (error - mean) * (error - mean).transpose() / (n - 1.0);
  study.range_error_m = mean[0];
  study.bearing_error_rad = mean[1];
  return study;
}

/// The mean of errors of places and their standard deviation about it.
struct MeanError {
  Value mean, scatter;
};

MeanError mean_of(const std::vector<double>& errors) {
  const auto n = static_cast<double>(errors.size());
  const double mean = std::accumulate(errors.begin(), errors.end(), 0.0) / n;
  double sum = 0.0;
  for (const double error : errors) sum += (error - mean) * (error - mean);
  const double scatter = std::sqrt(sum / (n - 1.0));
  return {{mean, scatter / std::sqrt(n)}, {scatter, scatter / std::sqrt(2.0 * (n - 1.0))}};
}

/// error = offset + (scale - 1) range, by least squares over the places.
void fit_range_line(const std::vector<const PlaceStudy*>& places, StaticStudy& study) {
  constexpr double kApart_m = 0.05;
  std::vector<double> errors, distances;
  for (const PlaceStudy* each : places) {
    errors.push_back(each->range_error_m);
    distances.push_back(each->place.range_m);
  }
  const MeanError alone = mean_of(errors);
  study.range_offset_m = alone.mean;
  study.range_scatter_m = alone.scatter;
  std::ranges::sort(distances);
  int apart = 1;
  for (std::size_t i = 1; i < distances.size(); ++i) apart += distances[i] - distances[i - 1] > kApart_m;
  if (apart < 3) return;
  Eigen::Matrix2d A = Eigen::Matrix2d::Zero();
  Eigen::Vector2d b = Eigen::Vector2d::Zero();
  for (const PlaceStudy* each : places) {
    const Eigen::Vector2d row(1.0, each->place.range_m);
    A += row * row.transpose();
    b += each->range_error_m * row;
  }
  const Eigen::Matrix2d P = A.inverse();
  const Eigen::Vector2d line = P * b;
  double sum = 0.0;
  for (const PlaceStudy* each : places)
    sum += std::pow(each->range_error_m - line[0] - line[1] * each->place.range_m, 2);
  const double left = static_cast<double>(places.size()) - 2.0;
  const double scatter = std::sqrt(sum / left);
  study.range_scale = Value{1.0 + line[1], scatter * std::sqrt(P(1, 1))};
  study.range_offset_m = {line[0], scatter * std::sqrt(P(0, 0))};
  study.range_scatter_m = {scatter, scatter / std::sqrt(2.0 * left)};
}

/// Standard deviation of one observation at a place: how it repeats, and how places differ.
Value sigma_at(const PlaceStudy& place, double repeated, const Value& scatter) {
  const double variance = repeated + scatter.value * scatter.value;
  const double of_repeated = std::sqrt(2.0 / std::max(1, place.observations - 1)) * repeated;
  const double of_scatter = 2.0 * scatter.value * scatter.sigma;
  const double sigma = std::sqrt(variance);
  return {sigma, sigma > 0.0 ? std::hypot(of_repeated, of_scatter) / (2.0 * sigma) : 0.0};
}

/// The last usable place towards one end, if one beyond it is not usable.
std::optional<double> edge(const std::vector<PlaceStudy>& places,
                           const std::function<double(const PlaceStudy&)>& at) {
  std::optional<double> last;
  for (const PlaceStudy& each : places)
    if (each.is_usable() && (!last || at(each) > *last)) last = at(each);
  const bool is_bounded = last && std::ranges::any_of(places, [&](const PlaceStudy& each) {
                            return !each.is_usable() && at(each) > *last;
                          });
  return is_bounded ? last : std::nullopt;
}

/// A place out of view to the side says nothing of ranges, nor one out of range of the view.
SensorLimits limits_of(const std::vector<PlaceStudy>& places) {
  double reach_m = 0.0, nearest_m = 1e9, widest_rad = 0.0;
  for (const PlaceStudy& each : places)
    if (each.is_usable()) {
      reach_m = std::max(reach_m, each.place.range_m);
      nearest_m = std::min(nearest_m, each.place.range_m);
      widest_rad = std::max(widest_rad, std::abs(each.place.bearing_rad));
    }
  std::vector<PlaceStudy> ahead, within;
  std::ranges::copy_if(places, std::back_inserter(ahead), [&](const PlaceStudy& each) {
    return std::abs(each.place.bearing_rad) <= widest_rad;
  });
  std::ranges::copy_if(places, std::back_inserter(within), [&](const PlaceStudy& each) {
    return each.place.range_m >= nearest_m && each.place.range_m <= reach_m;
  });
  const auto negative = [](const std::optional<double>& value) {
    return value ? std::optional(-*value) : std::nullopt;
  };
  return {.min_range_m = negative(edge(ahead, [](const auto& each) { return -each.place.range_m; })),
          .max_range_m = edge(ahead, [](const auto& each) { return each.place.range_m; }),
          .left_rad = edge(within, [](const auto& each) { return each.place.bearing_rad; }),
          .right_rad = negative(edge(within, [](const auto& each) { return -each.place.bearing_rad; }))};
}

std::vector<std::string> notes_of(const StaticStudy& study) {
  std::vector<std::string> notes;
  const SensorLimits& limits = study.limits;
  if (!study.range_scale)
    notes.emplace_back("scale and offset of ranges cannot be separated: measure at three or more distances");
  if (!limits.max_range_m)
    notes.emplace_back("the maximum range is not observable: no place ahead of the sensor was too far");
  if (!limits.min_range_m)
    notes.emplace_back("the minimum range is not observable: no place ahead of the sensor was too near");
  if (limits.left_rad.has_value() != limits.right_rad.has_value())
    notes.emplace_back(
        fmt::format("the field of view ends {:.1f} deg to the {}; its other end was not measured and may be "
                    "at another angle",
                    to_degrees(std::abs(limits.left_rad ? *limits.left_rad : *limits.right_rad)),
                    limits.left_rad ? "left" : "right"));
  if (!limits.left_rad && !limits.right_rad)
    notes.emplace_back(
        "the field of view is not observable: no place was outside of it to the left or right");
  return notes;
}

bool is_observable(const Value& value, double neutral) {
  return std::abs(value.value - neutral) > 2.0 * value.sigma;
}

}  // namespace

Result<std::vector<StaticPlace>> read_places(const fs::path& file) {
  auto table = TextTable::open(file, {.columns = "log,range_m,bearing_deg,id", .may_lack = "id"});
  if (!table) return table.error();
  std::vector<StaticPlace> places;
  while (table->next()) {
    StaticPlace place{(file.parent_path() / fs::path(table->text(0))).string(), table->number(1),
                      to_radians(table->number(2)), std::nullopt};
    if (!table->is_empty(3)) place.id = table->integer(3);
    if (!table->error() && !(place.range_m > 0.0)) table->fail("range_m: expected a distance above 0");
    if (table->error()) break;
    places.push_back(std::move(place));
  }
  if (table->error()) return *table->error();
  if (places.empty()) return Error{file.string() + ": the table has no rows"};
  return places;
}

Result<StaticStudy> study_of(std::vector<PlaceStudy> places) {
  StaticStudy study;
  study.places = std::move(places);
  std::vector<const PlaceStudy*> usable;
  std::vector<double> bearing_errors;
  for (const PlaceStudy& each : study.places) {
    if (!each.is_usable()) continue;
    usable.push_back(&each);
    bearing_errors.push_back(each.bearing_error_rad);
  }
  if (usable.size() < 2)
    return Error{
        fmt::format("only {} of {} places were observed in half of their scans; at least two are needed to "
                    "separate a bias from a wrongly measured place",
                    usable.size(), study.places.size())};
  fit_range_line(usable, study);
  const MeanError bearing = mean_of(bearing_errors);
  study.bearing_offset_rad = bearing.mean;
  study.bearing_scatter_rad = bearing.scatter;
  std::vector<NoiseBin> bins;
  double repeated = 0.0;
  PlaceStudy all;
  for (const PlaceStudy* each : usable) {
    bins.push_back({each->place.range_m, each->observations, each->range_error_m,
                    sigma_at(*each, each->covariance(0, 0), study.range_scatter_m)});
    repeated += each->covariance(1, 1) * (each->observations - 1);
    all.observations += each->observations - 1;
  }
  std::ranges::sort(bins, {}, &NoiseBin::at);
  study.range = fit_range_noise(bins);
  ++all.observations;
  study.bearing_sigma_rad = sigma_at(all, repeated / (all.observations - 1), study.bearing_scatter_rad);
  study.limits = limits_of(study.places);
  study.notes = notes_of(study);
  return study;
}

Result<StaticStudy> study_places(const std::vector<StaticPlace>& places, const UserSettings& user,
                                 const std::function<bool(double)>& keep_going) {
  std::vector<PlaceStudy> studied;
  Config before;
  for (const StaticPlace& place : places) {
    if (keep_going && !keep_going(static_cast<double>(studied.size()) / static_cast<double>(places.size())))
      return Error{"stopped before all recordings were read", Error::Kind::kFailed};
    auto opened = open_input(place.log, user);
    if (!opened) return opened.error();
    before = opened->config;
    const auto shown = read_recording(*opened);
    if (!shown) return shown.error();
    const auto landmark_observations = observations_of(place, *shown);
    if (!landmark_observations) return landmark_observations.error();
    studied.push_back(study_of(place, shown->scans, *landmark_observations));
  }
  auto study = study_of(std::move(studied));
  if (study) study->before = before;
  return study;
}

std::string to_yaml(const StaticStudy& study) {
  std::string yaml =
      "# Calibration of a landmark sensor from recordings at known places; use it with --config.\n";
  const auto add = [&yaml](const char* key, double value, double sigma) {
    yaml += fmt::format("{}: {:.6g}  # +- {:.2g}\n", key, value, sigma);
  };
  const LandmarkSensor& before = study.before.sensor;
  const bool markers = study.before.observe == Observe::kMarkers;
  const Value scale = study.range_scale.value_or(Value{1.0, 0.0});
  if (study.range_scale && is_observable(scale, 1.0))
    add("sensor.range_scale", before.range_scale * scale.value, before.range_scale * scale.sigma);
  if (is_observable(study.range_offset_m, 0.0))
    add("sensor.range_offset_m", before.range_offset_m + before.range_scale * study.range_offset_m.value,
        before.range_scale * study.range_offset_m.sigma);
  if (is_observable(study.bearing_offset_rad, 0.0))
    add(markers ? "camera.mount_yaw_deg" : "sensor.yaw_deg",
        before.yaw_deg - to_degrees(study.bearing_offset_rad.value),
        to_degrees(study.bearing_offset_rad.sigma));
  if (study.range) {
    add("sensor.range_sigma_m", std::max(1e-6, study.range->sigma_m.value), study.range->sigma_m.sigma);
    add("sensor.range_sigma_ratio", study.range->sigma_ratio.value, study.range->sigma_ratio.sigma);
  }
  add("sensor.bearing_sigma_deg", std::max(1e-6, to_degrees(study.bearing_sigma_rad.value)),
      to_degrees(study.bearing_sigma_rad.sigma));
  const SensorLimits& limits = study.limits;
  if (limits.min_range_m) yaml += fmt::format("sensor.min_range_m: {:.6g}\n", *limits.min_range_m);
  if (limits.max_range_m) yaml += fmt::format("sensor.max_range_m: {:.6g}\n", *limits.max_range_m);
  if (limits.left_rad && limits.right_rad)
    yaml +=
        fmt::format("sensor.field_of_view_deg: {:.6g}\n", to_degrees(*limits.left_rad - *limits.right_rad));
  return yaml;
}

}  // namespace waymark::calibrate
