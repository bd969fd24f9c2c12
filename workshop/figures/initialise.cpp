#include "workshop/figures/initialise.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Eigenvalues>
#include <fmt/format.h>

#include "waymark/core/angle.hpp"
#include "waymark/core/gaussian.hpp"
#include "waymark/ekf/depth_particles.hpp"
#include "waymark/vision/landmark_finder.hpp"
#include "waymark/vision/new_corners.hpp"

#include "workbench/eval/median.hpp"
#include "workbench/logs/files.hpp"
#include "workbench/logs/image_file.hpp"
#include "workbench/report/base64.hpp"
#include "workshop/figures/desk_search.hpp"
#include "workshop/figures/hand_held.hpp"

namespace waymark {
namespace {

namespace fs = std::filesystem;
using Eigen::Matrix2d;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kSigma_px = 1.0;    // noise of the sequence's places, as its authors give it
constexpr double kDepthRatio = 0.3;  // sigma of the depth over the depth at which it is known
constexpr int kMaxMisses = 10;
constexpr std::size_t kMinImages = 8;
constexpr std::size_t kMaxUnderWay = 6;

/// The target before which the sequence begins.
const std::array<Vector3d, 4> kTarget{
    {{0.13477, 0.04074, 0.0}, {-0.04632, 0.04324, 0.0}, {0.13555, -0.08827, 0.0}, {-0.04969, -0.08697, 0.0}}};
constexpr double kStart_m = -0.60;

struct InitialiseRequest {
  std::string folder;
  std::string drawing;
};

/// One image in the life of a candidate.
struct Glance {
  std::size_t image;
  Vector2d predicted;
  Matrix2d S;
  std::optional<Vector2d> found;
  std::vector<std::pair<Vector2d, double>> particles;  ///< where each would be seen, and its weight
  ekf::DepthParticles::Spread depth_m;                 ///< afterwards
};

/// A corner whose depth particles find out.
struct Candidate {
  std::size_t track;
  vision::Appearance appearance;
  ekf::DepthParticles depths;
  std::vector<Glance> glances;
  int misses = 0;
  enum class End { kUnderWay, kKnown, kGivenUp } end = End::kUnderWay;
};

vision::Appearance appearance_at(const GreyImage& image, const Vector2d& pixel) {
  const auto u = static_cast<int>(std::lround(pixel.x())), v = static_cast<int>(std::lround(pixel.y()));
  const auto patch = vision::cut_reference(image, u, v);
  return {.seen_from = {}, .patch = {patch.value_or(vision::ReferencePatch{}), kDeskPatch_px}};
}

vision::LandmarkFinder finder_in(const GreyImage& image) {
  return desk_finder(image.width_px(), image.height_px());
}

/// Follows the target's corners and others for as long as three of the target's are seen.
class Tracks {
 public:
  explicit Tracks(const GreyImage& first)
      : finder_(finder_in(first)), new_corners_(desk_corners(first.width_px(), first.height_px())) {
    HandHeld start;
    start.p_world_camera.z() = kStart_m;
    cameras.push_back(start);
    for (const Vector3d& corner : kTarget) {
      const Vector2d pixel = lens.pixel(start.to_camera(corner)).value();
      target.push_back({corner, {}});
      followed_.push_back(
          {appearance_at(first, pixel), pixel.array().round().matrix(), target.size() - 1, true});
    }
    cut_new(first, 0);
  }

  bool see(const GreyImage& image) {
    const std::size_t number = cameras.size();
    std::vector<KnownObservation> seen;
    std::vector<double> du, dv;
    for (Followed& each : followed_) {
      const auto finding =
          finder_.search_for({.predicted_px = each.pixel + motion_, .S = desk_prediction_covariance()}, image,
                             {}, each.appearance);
      each.ended = finding.result != vision::SearchRecord::Result::kFound;
      if (each.ended) continue;
      du.push_back(finding.pixel.x() - each.pixel.x());
      dv.push_back(finding.pixel.y() - each.pixel.y());
      each.pixel = finding.pixel;
      auto& places = each.of_target ? target[each.index].places : tracks[each.index].places;
      places.push_back({number, finding.pixel});
      if (each.of_target) seen.push_back({target[each.index].p_world, finding.pixel});
    }
    std::erase_if(followed_, [](const Followed& each) { return each.ended; });
    const auto place = resect(lens, cameras.back(), seen, kSigma_px);
    if (!place) return false;
    cameras.push_back(*place);
    motion_ = {eval::median(du).value_or(0.0), eval::median(dv).value_or(0.0)};
    cut_new(image, number);
    return true;
  }

  WideAngleLens lens;
  std::vector<HandHeld> cameras;  ///< one an image
  std::vector<KnownTrack> target;
  std::vector<RayTrack> tracks;
  std::vector<vision::Appearance> appearances;  ///< of each track

 private:
  struct Followed {
    vision::Appearance appearance;
    Vector2d pixel;
    std::size_t index;
    bool of_target = false;
    bool ended = false;
  };

  void cut_new(const GreyImage& image, std::size_t number) {
    std::vector<Vector2d> taken;
    for (const Followed& each : followed_) taken.push_back(each.pixel);
    for (const vision::Corner& corner : find_more(new_corners_, image, taken)) {
      const Vector2d pixel(corner.u, corner.v);
      tracks.push_back({number, lens.ray(pixel), -1.0 / kStart_m, {{number, pixel}}});
      appearances.push_back(appearance_at(image, pixel));
      followed_.push_back({appearances.back(), pixel, tracks.size() - 1});
    }
  }

  vision::LandmarkFinder finder_;
  vision::NewCorners new_corners_;
  std::vector<Followed> followed_;
  Vector2d motion_ = Vector2d::Zero();
};

/// Finds the depths of corners again, image by image, from where the camera was.
class Initialiser {
 public:
  Initialiser(const Tracks& all, const GreyImage& image) : all_(all), finder_(finder_in(image)) {}

  void see(const GreyImage& image) {
    for (Candidate& candidate : candidates_)
      if (candidate.end == Candidate::End::kUnderWay) search_for(candidate, image);
    begin_new();
    ++number_;
  }

  [[nodiscard]] const std::vector<Candidate>& candidates() const { return candidates_; }

 private:
  [[nodiscard]] std::optional<Vector2d> predict(const Candidate& candidate, double rho_per_m) const {
    const RayTrack& track = all_.tracks[candidate.track];
    const Vector3d p_world = all_.cameras[track.anchor].to_world(track.xy.homogeneous() / rho_per_m);
    return all_.lens.pixel(all_.cameras[number_].to_camera(p_world));
  }

  void search_for(Candidate& candidate, const GreyImage& image) {
    const auto rho = candidate.depths.inverse_depth();
    const auto predicted = predict(candidate, rho.mean);
    const auto beyond = predict(candidate, rho.mean + rho.sigma);
    if (!predicted || !beyond) return give_up(candidate);
    const Vector2d along = *beyond - *predicted;
    const Matrix2d S = noise() + along * along.transpose();
    const auto finding =
        finder_.search_for({.predicted_px = *predicted, .S = S}, image, {}, candidate.appearance);
    if (finding.result == vision::SearchRecord::Result::kNotTried) return give_up(candidate);
    auto particles = where_particles_are(candidate);
    const bool found =
        finding.result == vision::SearchRecord::Result::kFound && weigh(candidate, finding.pixel);
    if (!found) ++candidate.misses;
    candidate.glances.push_back({number_, *predicted, S, found ? std::optional(finding.pixel) : std::nullopt,
                                 std::move(particles), candidate.depths.depth()});
    if (candidate.misses >= kMaxMisses) return give_up(candidate);
    const auto& depth = candidate.glances.back().depth_m;
    if (candidate.glances.size() >= kMinImages && depth.sigma < kDepthRatio * depth.mean)
      candidate.end = Candidate::End::kKnown;
  }

  static void give_up(Candidate& candidate) { candidate.end = Candidate::End::kGivenUp; }

  static Matrix2d noise() { return kSigma_px * kSigma_px * Matrix2d::Identity(); }

  /// w <- w N(z; h(rho), R); false where no depth explains the place.
  bool weigh(Candidate& candidate, const Vector2d& pixel) {
    const double best = candidate.depths.score([&](double rho_per_m) {
      const auto h = predict(candidate, rho_per_m);
      return h ? -0.5 * mahalanobis_squared<2>(pixel - *h, noise()).value_or(HUGE_VAL) : -HUGE_VAL;
    });
    if (!std::isfinite(best)) return false;
    candidate.depths.take();
    return true;
  }

  [[nodiscard]] std::vector<std::pair<Vector2d, double>> where_particles_are(
      const Candidate& candidate) const {
    std::vector<std::pair<Vector2d, double>> places;
    for (const auto& [rho_per_m, weight] : candidate.depths.weighted())
      if (const auto pixel = predict(candidate, rho_per_m)) places.emplace_back(*pixel, weight);
    return places;
  }

  /// Some of the corners that were cut in this image.
  void begin_new() {
    auto under_way =
        static_cast<std::size_t>(std::ranges::count(candidates_, Candidate::End::kUnderWay, &Candidate::end));
    for (std::size_t k = 0; k < all_.tracks.size() && under_way < kMaxUnderWay; ++k) {
      if (all_.tracks[k].anchor != number_) continue;
      ++under_way;
      candidates_.push_back({.track = k,
                             .appearance = all_.appearances[k],
                             .depths = ekf::DepthParticles({.particles = 100,
                                                            .nearest_m = 0.5,
                                                            .farthest_m = 5.0,
                                                            .spacing = ekf::DepthPrior::Spacing::kDepth})});
    }
  }

  const Tracks& all_;
  vision::LandmarkFinder finder_;
  std::vector<Candidate> candidates_;
  std::size_t number_ = 0;
};

std::size_t count(const Initialiser& all, Candidate::End end) {
  return static_cast<std::size_t>(std::ranges::count(all.candidates(), end, &Candidate::end));
}

void print(const Initialiser& all, const Tracks& tracks, double rms_px) {
  std::vector<double> needed, depths_m, differences;
  for (const Candidate& candidate : all.candidates()) {
    if (candidate.end != Candidate::End::kKnown) continue;
    const auto depth = candidate.depths.depth();
    needed.push_back(static_cast<double>(candidate.glances.size()));
    depths_m.push_back(depth.mean);
    differences.push_back(std::abs(depth.mean - 1.0 / tracks.tracks[candidate.track].rho_per_m) /
                          depth.sigma);
  }
  fmt::print("{} images with the target in view; poses from {} corners at once, {:.2f} px RMS are left\n",
             tracks.cameras.size(), tracks.tracks.size(), rms_px);
  fmt::print("{} corners begun, {} known to {} of their depth or better, {} given up\n",
             all.candidates().size(), count(all, Candidate::End::kKnown), kDepthRatio,
             count(all, Candidate::End::kGivenUp));
  fmt::print(
      "images until then, median {:.0f}; depth, median {:.2f} m; off what all images say by {:.1f} "
      "sigma, median\n",
      eval::median(needed).value_or(NAN), eval::median(depths_m).value_or(NAN),
      eval::median(differences).value_or(NAN));
}

constexpr int kTile_px = 48;   // of the image
constexpr int kMagnified = 3;  // times
constexpr int kTilesInAStrip = 7;
constexpr int kStrips = 6;

std::string ellipse_svg(const Vector2d& centre, const Matrix2d& S) {
  const Eigen::SelfAdjointEigenSolver<Matrix2d> axes(S);
  constexpr double kSigmas = 3.0;
  const Vector2d radii = kSigmas * axes.eigenvalues().cwiseMax(0.0).cwiseSqrt();
  const Vector2d major = axes.eigenvectors().col(1);
  return fmt::format(
      "<ellipse cx=\"{:.2f}\" cy=\"{:.2f}\" rx=\"{:.2f}\" ry=\"{:.2f}\" transform=\"rotate({:.1f} {:.2f} "
      "{:.2f})\" fill=\"none\" stroke=\"#00b4ff\" stroke-width=\"0.5\"/>",
      centre.x(), centre.y(), radii.y(), radii.x(), to_degrees(std::atan2(major.y(), major.x())), centre.x(),
      centre.y());
}

/// The piece of an image around the search, with what was looked for in it.
Result<std::string> tile_svg(const Glance& glance, const GreyImage& image) {
  const auto corner_of = [](double middle, int size) {
    return std::clamp(static_cast<int>(std::lround(middle)) - kTile_px / 2, 0, size - kTile_px);
  };
  const int u = corner_of(glance.predicted.x(), image.width_px());
  const int v = corner_of(glance.predicted.y(), image.height_px());
  const auto png = encode_png(image.view().part(u, v, kTile_px, kTile_px));
  if (!png) return png.error();
  std::string svg = fmt::format(
      "<svg width=\"{0}\" height=\"{0}\" viewBox=\"{1} {2} {3} {3}\"><image x=\"{1}\" y=\"{2}\" "
      "width=\"{3}\" "
      "height=\"{3}\" style=\"image-rendering:pixelated\" href=\"data:image/png;base64,{4}\"/>{5}",
      kTile_px * kMagnified, u - 0.5, v - 0.5, kTile_px, base64(*png),
      ellipse_svg(glance.predicted, glance.S));
  double most = 0.0;
  for (const auto& [place, weight] : glance.particles) most = std::max(most, weight);
  for (const auto& [place, weight] : glance.particles)
    svg += fmt::format(R"(<circle cx="{:.2f}" cy="{:.2f}" r="{:.2f}" fill="#ffd500"/>)", place.x(), place.y(),
                       0.15 + 0.75 * weight / most);
  if (glance.found)
    svg += fmt::format(R"(<circle cx="{:.2f}" cy="{:.2f}" r="1.6" fill="none" stroke="#e8112d"/>)",
                       glance.found->x(), glance.found->y());
  return svg + "</svg>";
}

/// First and last image of a candidate and some between.
std::vector<Glance> chosen(const Candidate& candidate) {
  std::vector<Glance> glances;
  const std::size_t all = candidate.glances.size();
  const std::size_t shown = std::min(all, static_cast<std::size_t>(kTilesInAStrip));
  for (std::size_t k = 0; k < shown; ++k)
    glances.push_back(candidate.glances[shown > 1 ? k * (all - 1) / (shown - 1) : 0]);
  return glances;
}

Result<std::string> draw(const Initialiser& all, const std::vector<fs::path>& files) {
  constexpr int kPitch_px = kTile_px * kMagnified + 6, kRow = kTile_px * kMagnified + 26;
  std::vector<const Candidate*> strips;
  for (const Candidate& candidate : all.candidates())
    if (candidate.end != Candidate::End::kUnderWay && candidate.glances.size() >= 4)
      strips.push_back(&candidate);
  strips.resize(std::min(strips.size(), static_cast<std::size_t>(kStrips)));
  const int width = kTilesInAStrip * kPitch_px + 10, height = static_cast<int>(strips.size()) * kRow + 10;
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" font-family=\"sans-serif\" "
      "font-size=\"11\">\n<rect width=\"{0}\" height=\"{1}\" fill=\"white\"/>\n",
      width, height);
  for (int row = 0; const Candidate* candidate : strips) {
    for (int column = 0; const Glance& glance : chosen(*candidate)) {
      const auto image = read_image(files[glance.image]);
      if (!image) return image.error();
      const auto tile = tile_svg(glance, *image);
      if (!tile) return tile.error();
      svg += fmt::format(
          "<g transform=\"translate({},{})\">{}<text y=\"{}\">image {}: {:.2f} &#177; {:.2f} "
          "m</text></g>\n",
          10 + column * kPitch_px, 10 + row * kRow, *tile, kTile_px * kMagnified + 13, glance.image,
          glance.depth_m.mean, glance.depth_m.sigma);
      ++column;
    }
    ++row;
  }
  return svg + "</svg>\n";
}

Result<void> initialise_over(const InitialiseRequest& request) {
  const auto files = desk_images(request.folder);
  if (!files) return files.error();
  const auto first = read_image(files->front());
  if (!first) return first.error();
  Tracks tracks(*first);
  for (std::size_t k = 1; k < files->size(); ++k) {
    const auto image = read_image((*files)[k], ImageSize{first->width_px(), first->height_px()});
    if (!image) return image.error();
    if (!tracks.see(*image)) break;
  }
  const double rms_px = bundle(tracks.lens, tracks.cameras, tracks.target, tracks.tracks);
  Initialiser initialiser(tracks, *first);
  for (std::size_t k = 0; k < tracks.cameras.size(); ++k) {
    const auto image = read_image((*files)[k]);
    if (!image) return image.error();
    initialiser.see(*image);
  }
  print(initialiser, tracks, rms_px);
  if (request.drawing.empty()) return {};
  const auto drawing = draw(initialiser, *files);
  return drawing ? write_file(request.drawing, *drawing) : Result<void>(drawing.error());
}

int initialise(const InitialiseRequest& request) {
  const auto done = initialise_over(request);
  if (!done) fmt::print(stderr, "{}\n", done.error().message);
  return done ? 0 : 1;
}

}  // namespace

void add_initialise(CLI::App& app, int& status) {
  auto* command = app.add_subcommand("initialise", "depths of new corners in images of a hand-held camera");
  auto request = std::make_shared<InitialiseRequest>();
  command->add_option("folder", request->folder, "monoslam-desk: a folder with images in frames/")
      ->required();
  command->add_option("-o,--output", request->drawing, "draw strips of it as well")->type_name("FILE.svg");
  command->callback([request, &status] { status = initialise(*request); });
}

}  // namespace waymark
