#include "waymark/slam/make_filter.hpp"

namespace waymark {
namespace {

std::optional<ekf::UnnamedOptions> unnamed(const Config& config) {
  if (config.associate == Association::kKnown) return std::nullopt;
  return ekf::UnnamedOptions{config.associate == Association::kJcbb, config.association, config.sensor};
}

Result<std::unique_ptr<Filter>> make_ekf(const Config& config) {
  if (config.associate == Association::kMl)
    return Error{"associate: ml needs filter=fastslam; the EKF takes known, nearest or jcbb"};
  if (config.associate != Association::kKnown && config.observe == Observe::kPixel)
    return Error{"associate: pixels need identities: associate=known"};
  if (config.ekf.update == UpdateMethod::kTextbook &&
      (config.observe != Observe::kPixel || config.ekf.consistency != ekf::Consistency::kStandard))
    return Error{"ekf.update: textbook needs observe=pixel and ekf.consistency=standard"};
  switch (config.observe) {
    case Observe::kRangeBearing:
    case Observe::kMarkers:
      return std::unique_ptr<Filter>(std::make_unique<EkfSlam>(config.ekf, config.gate,
                                                               config.sensor.T_robot_sensor(), config.threads,
                                                               config.sensor.errors, unnamed(config)));
    case Observe::kPixel:
      return std::unique_ptr<Filter>(
          std::make_unique<PixelSlam>(config.ekf, config.pixel, config.camera, config.threads));
    case Observe::kRange:
    case Observe::kBearing:
      return Error{
          "observe: the EKF takes range-bearing and pixel so far; range or bearing alone: filter=fastslam"};
  }
  return Error{"observe: unknown"};
}

Result<std::unique_ptr<Filter>> make_fastslam(const Config& config) {
  if (config.observe == Observe::kPixel)
    return Error{"filter: fastslam does not take pixels; filter=ekf does, or choose another observe"};
  if (config.associate == Association::kNearest || config.associate == Association::kJcbb)
    return Error{"associate: nearest and jcbb need filter=ekf; FastSLAM takes known or ml"};
  const bool by_likelihood = config.associate == Association::kMl;
  if (by_likelihood && (config.observe == Observe::kRange || config.observe == Observe::kBearing))
    return Error{
        "associate: ml takes range-bearing; range or bearing alone needs identities: associate=known"};
  return std::unique_ptr<Filter>(std::make_unique<FastSlam>(
      config.fastslam, config.gate, config.sensor, config.seed, config.threads, PoseEstimate{},
      by_likelihood ? std::optional(config.association) : std::nullopt));
}

}  // namespace

Result<std::unique_ptr<Filter>> make_filter(const Config& config) {
  return config.filter == FilterKind::kEkf ? make_ekf(config) : make_fastslam(config);
}

std::unique_ptr<CameraFrontEnd> make_front_end(const Config& config, Filter& filter) {
  auto* pixels = dynamic_cast<PixelSlam*>(&filter);
  if (pixels == nullptr) return nullptr;
  return std::make_unique<CameraFrontEnd>(*pixels, config.tracker, config.search, Camera(config.camera),
                                          config.threads);
}

Result<std::unique_ptr<MarkerFrontEnd>> make_marker_front_end(const Config& config) {
  if (config.observe != Observe::kMarkers) return std::unique_ptr<MarkerFrontEnd>();
  return MarkerFrontEnd::make(config.markers, Camera(config.camera));
}

const char* filter_name(FilterKind kind) { return kind == FilterKind::kEkf ? "EKF-SLAM" : "FastSLAM"; }

}  // namespace waymark
