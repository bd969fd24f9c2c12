#include "workbench/sim/renderer.hpp"

#include <cmath>
#include <optional>
#include <utility>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "waymark/core/random.hpp"

#include "workbench/sim/textures.hpp"

namespace waymark::sim {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr int kSquare = 64;  // texels

/// Squares of 64 texels, dark and light.
Canvas checkerboard(float dark, float light) {
  Canvas canvas(9, 9, dark);
  for (int y = 0; y < canvas.height(); y += kSquare)
    for (int x = 0; x < canvas.width(); x += kSquare)
      if ((x + y) / kSquare % 2 == 1) canvas.fill({x, y, kSquare, kSquare}, light);
  return canvas;
}

CameraOptions some_camera(double k1 = -0.2) {
  CameraOptions options;
  options.distortion = {.k1 = k1, .k2 = 0.05, .p1 = 0.002, .p2 = -0.001};
  return options;
}

/// Grey to a fraction: the mean of what many noisy images would show.
GreyImage render(const Camera& camera, const Scene& scene, const Viewpoint& viewpoint, int threads = 1) {
  ThreadPool pool(threads);
  Renderer renderer(camera, pool);
  renderer.expose(scene.textures, scene.rectangles, viewpoint, 1.0);
  return renderer.apply_image_noise({.weights = {0.6F, 0.19F, 0.01F, 0.0F}});
}

double grey_at(const GreyImage& image, const Vector2d& pixel) {
  const int u = static_cast<int>(std::floor(pixel.x()));
  const int v = static_cast<int>(std::floor(pixel.y()));
  const double fu = pixel.x() - u, fv = pixel.y() - v;
  return (1.0 - fv) * ((1.0 - fu) * image(u, v) + fu * image(u + 1, v)) +
         fv * ((1.0 - fu) * image(u, v + 1) + fu * image(u + 1, v + 1));
}

/// How far beyond `pixel` an edge lies, in pixels along `across`, a unit vector: where a profile of the image
/// passes the middle between its ends, by the area under it. Nothing where the ends hardly differ.
std::optional<double> edge_offset(const GreyImage& image, const Vector2d& pixel, const Vector2d& across) {
  constexpr double kReach = 4.0, kStep = 0.05;
  const double before = grey_at(image, pixel - kReach * across);
  const double after = grey_at(image, pixel + kReach * across);
  if (std::abs(after - before) < 40.0) return std::nullopt;
  double area = 0.0;
  for (double x = -kReach + 0.5 * kStep; x < kReach; x += kStep)
    area += kStep * (grey_at(image, pixel + x * across) - before) / (after - before);
  return kReach - area;
}

/// A room whose walls are checkerboards, one block in it.
Scene checkered_room() {
  Scene scene;
  scene.textures.emplace_back(checkerboard(60.0F, 160.0F));
  add_hull({.low_m = {-5.0, -5.0}, .high_m = {5.0, 5.0}}, 0, 0, scene.rectangles);
  return scene;
}

Viewpoint random_viewpoint(const Camera& camera, RandomStream& random) {
  const CameraPose pose =
      camera.pose({random.uniform(-2.0, 2.0), random.uniform(-2.0, 2.0), random.uniform(-kPi, kPi)});
  const auto small = [&] { return random.uniform(-0.1, 0.1); };
  const Eigen::Matrix3d tilt =
      (Eigen::AngleAxisd(small(), Vector3d::UnitX()) * Eigen::AngleAxisd(small(), Vector3d::UnitZ()))
          .toRotationMatrix();
  return {tilt * pose.R_camera_world, pose.p_world_camera + Vector3d(0.0, 0.0, random.uniform(0.0, 1.0))};
}

struct Statistics {
  int count = 0;
  double sum = 0.0;
  double squares = 0.0;

  void add(double x) {
    ++count;
    sum += x;
    squares += x * x;
  }
  [[nodiscard]] double mean() const { return sum / count; }
  [[nodiscard]] double rms() const { return std::sqrt(squares / count); }
};

/// Where an image shows a point and a short way along an edge and across it on a surface.
struct EdgeImage {
  Vector2d pixel;
  Vector2d across;  ///< unit vector, perpendicular to the edge in the image
};

std::optional<EdgeImage> image_of_edge(const Camera& camera, const Viewpoint& from, const Vector3d& p_world,
                                       const Vector3d& along_world, double border_px) {
  const auto image = camera.project(from.R_camera_world * (p_world - from.p_world_camera));
  if (!image || !camera.sees(image->pixel, border_px)) return std::nullopt;
  const Vector2d along = image->dpixel_dpoint * (from.R_camera_world * along_world);
  if (along.norm() < 1e-6) return std::nullopt;
  return EdgeImage{image->pixel, Vector2d(-along.y(), along.x()).normalized()};
}

constexpr double kSquare_m = kSquare * kTexel_m;

/// The middle of a side of a square on a wall.
struct SquareSide {
  Vector3d p_world, along, across;  ///< unit vectors on the wall
};

SquareSide random_side(const Rectangle& wall, RandomStream& random) {
  const auto cell = [&](double size_m) {
    return 1.0 + std::floor(random.uniform(0.0, size_m / kSquare_m - 2.0));
  };
  const bool upright = random.uniform() < 0.5;
  const double s = cell(wall.width_m) + (upright ? 0.0 : 0.5);
  const double t = cell(wall.height_m) + (upright ? 0.5 : 0.0);
  const Vector3d p = wall.corner_m + kSquare_m * (s * wall.along_s + t * wall.along_t);
  if (upright) return {p, wall.along_t, wall.along_s};
  return {p, wall.along_s, wall.along_t};
}

/// The image of a side whose squares are large enough there for a profile to begin and end on even grey.
std::optional<EdgeImage> image_of_side(const Camera& camera, const Viewpoint& from, const SquareSide& side) {
  const auto edge = image_of_edge(camera, from, side.p_world, side.along, 8.0);
  const auto project = [&](const Vector3d& offset) {
    return camera.project(from.R_camera_world * (side.p_world + offset - from.p_world_camera));
  };
  const auto beside = project(0.45 * kSquare_m * side.across);
  const auto end = project(0.45 * kSquare_m * side.along);
  if (!edge || !beside || !end) return std::nullopt;
  const bool is_wide = std::abs((beside->pixel - edge->pixel).dot(edge->across)) > 8.0;
  return is_wide && (end->pixel - edge->pixel).norm() > 5.0 ? edge : std::nullopt;
}

// Edges between squares of the walls, floor and ceiling, anywhere in the image and seen at any slant: where
// the image shows them and where the camera model projects them.
TEST(Renderer, TextureEdgesLieWhereTheCameraModelProjectsThem) {
  RandomStream random(1, StreamPurpose::kWorld);
  const Camera camera(some_camera());
  const Scene scene = checkered_room();
  Statistics offsets;
  for (int i = 0; i < 40; ++i) {
    const Viewpoint from = random_viewpoint(camera, random);
    const GreyImage image = render(camera, scene, from);
    for (const Rectangle& wall : scene.rectangles) {
      for (int k = 0; k < 200; ++k) {
        const auto edge = image_of_side(camera, from, random_side(wall, random));
        if (!edge) continue;
        if (const auto offset = edge_offset(image, edge->pixel, edge->across)) offsets.add(*offset);
      }
    }
  }
  EXPECT_GT(offsets.count, 1000);
  EXPECT_NEAR(offsets.mean(), 0.0, 0.01);
  EXPECT_LT(offsets.rms(), 0.05);
}

// Upright edges of blocks in front of a wall far behind.
TEST(Renderer, SilhouettesLieWhereTheCameraModelProjectsThem) {
  RandomStream random(2, StreamPurpose::kWorld);
  const Camera camera(some_camera());
  Statistics offsets;
  for (int i = 0; i < 60; ++i) {
    Scene scene;
    scene.textures.emplace_back(Canvas(4, 4, 60.0F));
    scene.textures.emplace_back(Canvas(4, 4, 200.0F));
    add_hull({.low_m = {-5.0, -5.0}, .high_m = {5.0, 5.0}}, 0, 0, scene.rectangles);
    const Block block{.centre_m = {random.uniform(1.0, 3.0), random.uniform(-0.5, 0.5)},
                      .yaw_rad = random.uniform(-kPi, kPi),
                      .bottom_m = -1.0,
                      .size_m = {0.4, 0.4, 5.0},
                      .texture = 1};
    add_block(block, scene.rectangles);
    for (Rectangle& r : scene.rectangles) r.brightness = 1.0;  // no edges between faces
    const CameraPose pose = camera.pose({-1.5, 0.0, random.uniform(-0.1, 0.1)});
    const Viewpoint from{Eigen::AngleAxisd(random.uniform(-0.2, 0.2), Vector3d::UnitZ()).toRotationMatrix() *
                             pose.R_camera_world,
                         pose.p_world_camera};
    const GreyImage image = render(camera, scene, from);
    const Pose2 T_world_block{block.centre_m.x(), block.centre_m.y(), block.yaw_rad};
    // Of the four upright edges, the two that border on the wall are the outermost in the image.
    std::optional<EdgeImage> leftmost, rightmost;
    for (const auto& [x, y] : {std::pair{-0.2, -0.2}, {-0.2, 0.2}, {0.2, -0.2}, {0.2, 0.2}}) {
      const Vector2d corner = T_world_block * Vector2d(x, y);
      const auto edge = image_of_edge(camera, from, {corner.x(), corner.y(), random.uniform(0.2, 0.4)},
                                      Vector3d::UnitZ(), 8.0);
      if (!edge) continue;
      if (!leftmost || edge->pixel.x() < leftmost->pixel.x()) leftmost = edge;
      if (!rightmost || edge->pixel.x() > rightmost->pixel.x()) rightmost = edge;
    }
    for (const auto& edge : {leftmost, rightmost}) {
      if (!edge) continue;
      if (const auto offset = edge_offset(image, edge->pixel, edge->across)) offsets.add(*offset);
    }
  }
  EXPECT_GT(offsets.count, 80);
  EXPECT_NEAR(offsets.mean(), 0.0, 0.02);
  EXPECT_LT(offsets.rms(), 0.05);
}

TEST(Renderer, GreyIsThatOfTheTextureTimesItsBrightness) {
  const Camera camera(some_camera());
  Scene scene;
  scene.textures.emplace_back(Canvas(4, 4, 100.0F));
  add_hull({.low_m = {-5.0, -5.0}, .high_m = {5.0, 5.0}}, 0, 0, scene.rectangles);
  for (Rectangle& r : scene.rectangles) r.brightness = 1.3;
  const CameraPose pose = camera.pose({});
  const GreyImage image = render(camera, scene, {pose.R_camera_world, pose.p_world_camera});
  for (int v = 0; v < image.height_px(); ++v)
    for (int u = 0; u < image.width_px(); ++u) ASSERT_NEAR(image(u, v), 130, 1) << u << ' ' << v;
}

// From far and aslant a fine pattern becomes its mean, whatever the place: nothing shimmers.
TEST(Renderer, AFinePatternIsAveragedWithoutMoire) {
  const Camera camera(some_camera());
  Scene scene;
  Canvas fine(8, 8, 40.0F);
  for (int y = 0; y < fine.height(); ++y)
    for (int x = 0; x < fine.width(); ++x)
      if ((x + y) % 2 == 0) fine.at(x, y) = 220.0F;
  scene.textures.emplace_back(fine);
  add_hull({.low_m = {-5.0, -5.0}, .high_m = {5.0, 5.0}}, 0, 0, scene.rectangles);
  for (Rectangle& r : scene.rectangles) r.brightness = 1.0;
  const CameraPose pose = camera.pose({-4.0, 0.0, 0.1});
  const GreyImage image = render(camera, scene, {pose.R_camera_world, pose.p_world_camera});
  for (int v = 100; v < 130; ++v)
    for (int u = 60; u < 260; ++u) ASSERT_NEAR(image(u, v), 130, 2) << u << ' ' << v;
}

TEST(Renderer, GivesTheSameBitsOnAnyNumberOfThreads) {
  RandomStream random(3, StreamPurpose::kWorld);
  const Camera camera(some_camera());
  const Scene scene = checkered_room();
  const Viewpoint from = random_viewpoint(camera, random);
  const GreyImage one = render(camera, scene, from, 1);
  EXPECT_EQ(one, render(camera, scene, from, 2));
  EXPECT_EQ(one, render(camera, scene, from, 5));
}

// Tiles leave out what they cannot see: with a camera that is one tile large nothing can be left out wrongly
// between tiles, and every pixel of a large image is a pixel of such a small one.
TEST(Renderer, TilesSeeWhatTheWholeImageSees) {
  RandomStream random(4, StreamPurpose::kWorld);
  Scene scene = checkered_room();
  for (int i = 0; i < 30; ++i)
    add_block({.centre_m = {random.uniform(-4.0, 4.0), random.uniform(-4.0, 4.0)},
               .yaw_rad = random.uniform(-kPi, kPi),
               .size_m = {0.3, 0.5, random.uniform(0.2, 2.0)}},
              scene.rectangles);
  const CameraOptions options = some_camera();
  const Camera camera(options);
  for (int i = 0; i < 5; ++i) {
    const Viewpoint from = random_viewpoint(camera, random);
    const GreyImage whole = render(camera, scene, from);
    for (const auto& [u, v] : {std::pair{37, 21}, {150, 100}, {290, 200}}) {
      CameraOptions small = options;
      small.width_px = small.height_px = 16;
      small.cu_px -= u;
      small.cv_px -= v;
      const GreyImage part = render(Camera(small), scene, from);
      for (int y = 4; y < 12; ++y)
        for (int x = 4; x < 12; ++x) ASSERT_NEAR(part(x, y), whole(u + x, v + y), 1);
    }
  }
}

}  // namespace
}  // namespace waymark::sim
