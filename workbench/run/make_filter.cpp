#include "workbench/run/make_filter.hpp"

#include <fmt/format.h>

#include "waymark/ekf/localizer.hpp"
#include "waymark/ekf/pixel_slam.hpp"
#include "waymark/fastslam/fast_slam.hpp"
#include "waymark/markers/marker_front_end.hpp"
#include "waymark/slam/corner_front_end.hpp"

namespace waymark {
namespace {

/// The user's, or the filter's own.
int capacity_of(const Config& config, int usual) {
  return config.map.capacity > 0 ? config.map.capacity : usual;
}

/// The EKF correlates every landmark with every other.
Result<void> check_capacity(const Config& config) {
  const int most = config.filter == FilterKind::kFastSlam ? 1'000'000
                   : config.observe == Observe::kPixel    ? 2'000
                                                          : 20'000;
  if (config.map.capacity <= most) return {};
  return Error{fmt::format("map.capacity: {} landmarks are too many; this filter takes at most {}",
                           config.map.capacity, most)};
}

/// Where nothing tells how large the world is, distances are what the odometry says.
EkfOptions ekf_options(const Config& config, const std::optional<MapState>& start) {
  EkfOptions options = config.ekf;
  options.capacity = capacity_of(config, options.capacity);
  options.gate = config.gate;
  // One calibration with one prior, whoever estimates it.
  options.odometry.speed_scale_sigma = config.smooth.speed_scale_sigma;
  options.odometry.turn_scale_sigma = config.smooth.turn_scale_sigma;
  options.odometry.turn_bias_sigma_degps = config.smooth.turn_bias_sigma_degps;
  if (config.associate != Association::kKnown)
    options.unknown = UnknownAssociation{config.associate == Association::kJcbb, config.association};
  if (!observes_scale(config.observe, config.sensor.errors)) options.odometry.speed_scale_sigma = 0.0;
  if (start) options.loaded = static_cast<int>(start->ids.size());
  return options;
}

/// EKF-SLAM over ranges, bearings or both.
Result<FilterSystem> make_planar_ekf(const Config& config, const std::optional<MapState>& start) {
  const EkfOptions options = ekf_options(config, start);
  if (config.map.localize && start) {
    auto localizer = Localizer::make(*start, options, config.sensor, config.threads);
    if (!localizer) return localizer.error();
    return FilterSystem{*std::move(localizer), nullptr};
  }
  auto filter = std::make_unique<EkfSlam>(options, config.sensor, config.threads);
  if (start)
    if (auto loaded = filter->load(*start); !loaded) return loaded.error();
  return FilterSystem{std::move(filter), nullptr};
}

Result<FilterSystem> make_pixel_ekf(const Config& config, const std::optional<MapState>& start) {
  PixelSlamOptions options = config.pixel;
  options.capacity = capacity_of(config, options.capacity);
  options.consistency = config.ekf.consistency;
  options.jitter_deg = config.markers.jitter_deg;  // of the camera, whatever it looks for
  vision::TrackerOptions tracker = config.tracker;
  tracker.new_corners.max_candidates = options.max_candidates;
  auto filter = std::make_unique<PixelSlam>(options, config.camera, config.threads);
  auto front_end = std::make_unique<CornerFrontEnd>(*filter, tracker, config.search, Camera(config.camera),
                                                    config.threads);
  if (start) {
    if (auto loaded = filter->load(*start); !loaded) return loaded.error();
    front_end->remember(start->patches);
  }
  return FilterSystem{std::move(filter), std::move(front_end)};
}

Result<FilterSystem> make_ekf(const Config& config, const std::optional<MapState>& start) {
  if (config.associate == Association::kMl)
    return Error{"associate: ml needs filter=fastslam; the EKF takes known, nearest or jcbb"};
  if (config.associate != Association::kKnown && !observes_position(config.observe))
    return Error{
        "associate: observations by pixel, range alone or bearing alone need identities; set "
        "associate=known"};
  if (config.ekf.odometry.estimate &&
      (config.observe == Observe::kPixel || config.ekf.compressed == Compress::kAlways))
    return Error{
        "ekf.calibrate_odometry: cannot be used with observe=pixel or ekf.compressed=true, because it "
        "updates the whole map"};
  if (config.observe == Observe::kPixel) return make_pixel_ekf(config, start);
  return make_planar_ekf(config, start);
}

Result<FilterSystem> make_fastslam(const Config& config) {
  if (config.observe == Observe::kPixel)
    return Error{"filter: fastslam cannot use pixels; set filter=ekf or another value of observe"};
  if (config.associate == Association::kNearest || config.associate == Association::kJcbb)
    return Error{"associate: nearest and jcbb need filter=ekf; FastSLAM takes known or ml"};
  const bool by_likelihood = config.associate == Association::kMl;
  if (by_likelihood && (config.observe == Observe::kRange || config.observe == Observe::kBearing))
    return Error{
        "associate: ml takes range-bearing only; observations by range alone or bearing alone need "
        "identities; set associate=known"};
  FastSlamOptions options = config.fastslam;
  options.capacity = capacity_of(config, options.capacity);
  options.gate = config.gate;
  options.seed = config.seed;
  if (by_likelihood) options.unknown = config.association;
  return FilterSystem{std::make_unique<FastSlam>(options, config.sensor, config.threads), nullptr};
}

/// The methods of the article are those of one filter.
Result<void> check_article_methods(const Config& config) {
  if (config.pixel.update != UpdateMethod::kTextbook ||
      (config.observe == Observe::kPixel && config.ekf.consistency == ekf::Consistency::kStandard))
    return {};
  return Error{"pixel.article: needs observe=pixel and ekf.consistency=standard"};
}

/// Without what finds markers.
Result<FilterSystem> make_without_markers(const Config& config, const std::optional<MapState>& start) {
  if (auto fits = check_capacity(config); !fits) return fits.error();
  if (auto fits = check_article_methods(config); !fits) return fits.error();
  return config.filter == FilterKind::kEkf ? make_ekf(config, start) : make_fastslam(config);
}

}  // namespace

Result<std::optional<MapState>> read_start_map(const Config& config) {
  const bool pixels = config.observe == Observe::kPixel;
  if (config.map.localize && config.map.file.empty())
    return Error{"map.localize: needs a saved map: --map FILE (config key map.file)"};
  if (config.map.file.empty()) return std::optional<MapState>{};
  if (config.filter != FilterKind::kEkf || (!pixels && !observes_position(config.observe)))
    return Error{"map.file: a saved map needs filter=ekf and observe=range-bearing, markers or pixel"};
  if (config.map.localize && pixels)
    return Error{
        "map.localize: needs observe=range-bearing or markers; with observe=pixel a run can only continue "
        "from the pose in the map (map.localize=false)"};
  if (config.smooth.run)
    return Error{"smooth.run: cannot be used with a saved map (map.file); it needs the log from its start"};
  auto map = pixels ? read_start_map(config.map, 3, capacity_of(config, config.pixel.capacity))
                    : read_start_map(config.map, 2, capacity_of(config, config.ekf.capacity));
  if (!map) return map.error();
  return std::optional(*std::move(map));
}

Result<std::unique_ptr<FrontEnd>> make_marker_front_end(const Config& config) {
  if (config.observe != Observe::kMarkers) return std::unique_ptr<FrontEnd>();
  auto markers = MarkerFrontEnd::make(config.markers, Camera(config.camera));
  if (!markers) return markers.error();
  return std::unique_ptr<FrontEnd>(*std::move(markers));
}

Result<FilterSystem> make_filter_system(const Config& config, const std::optional<MapState>& start) {
  auto system = make_without_markers(config, start);
  if (!system || config.observe != Observe::kMarkers) return system;
  auto markers = make_marker_front_end(config);
  if (!markers) return markers.error();
  system->front_end = *std::move(markers);
  return system;
}

Result<std::unique_ptr<Filter>> make_filter(const Config& config) {
  const auto start = read_start_map(config);
  if (!start) return start.error();
  auto system = make_without_markers(config, *start);
  if (!system) return system.error();
  return std::move(system->filter);
}

}  // namespace waymark
