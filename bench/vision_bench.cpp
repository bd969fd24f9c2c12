// The kernels of the camera front end, each on every instruction set of this machine; items are candidates
// (ZMSSD) or frames (corners).
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

#include "waymark/core/grey_image.hpp"
#include "waymark/core/random.hpp"
#include "waymark/kernels/highway_targets.hpp"
#include "waymark/kernels/zmssd.hpp"
#include "waymark/vision/corners.hpp"
#include "waymark/vision/search.hpp"
#include "waymark/vision/subpixel.hpp"
#include "waymark/vision/tracker.hpp"

#include "workbench/logs/image_file.hpp"

#ifdef WAYMARK_WITH_OPENCV
#include <opencv2/features2d.hpp>
#include <opencv2/imgproc.hpp>
#endif

namespace waymark::kernels {
namespace {

// The mean of the pixels that each pixel of the smaller image covers.
GreyImage scaled(const ImageView& image, int width_px, int height_px) {
  GreyImage small(width_px, height_px);
  for (int v = 0; v < height_px; ++v) {
    for (int u = 0; u < width_px; ++u) {
      const int u0 = u * image.width_px / width_px,
                u1 = std::max((u + 1) * image.width_px / width_px, u0 + 1);
      const int v0 = v * image.height_px / height_px,
                v1 = std::max((v + 1) * image.height_px / height_px, v0 + 1);
      int sum = 0;
      for (int y = v0; y < v1; ++y)
        for (int x = u0; x < u1; ++x) sum += image(x, y);
      small(u, v) = static_cast<std::uint8_t>(sum / ((u1 - u0) * (v1 - v0)));
    }
  }
  return small;
}

// Squares of any size, where there are no photographs.
GreyImage squares() {
  RandomStream random(1, StreamPurpose::kWorld);
  GreyImage image(320, 240);
  for (int i = 0; i < 2000; ++i) {
    const int u0 = static_cast<int>(random.uniform(0.0, 320.0)),
              v0 = static_cast<int>(random.uniform(0.0, 240.0));
    const int side = static_cast<int>(random.uniform(2.0, 40.0));
    const auto grey = static_cast<std::uint8_t>(random.uniform(0.0, 256.0));
    for (int v = v0; v < std::min(v0 + side, 240); ++v)
      for (int u = u0; u < std::min(u0 + side, 320); ++u) image(u, v) = grey;
  }
  return image;
}

struct Frame {
  std::string name;
  GreyImage image;
};

// Photographs at 320 x 240, and the middle of a large one.
std::vector<Frame> make_frames() {
  std::vector<Frame> frames{{"squares", squares()}};
  const char* data = std::getenv("WAYMARK_DATA_DIR");
  const std::filesystem::path folder =
      std::filesystem::path(data != nullptr ? data : WAYMARK_DATA_DIR) / "gray-images";
  for (const char* name :
       {"graf1.png", "leuvenA.jpg", "building.jpg", "home.jpg", "rubberwhale1.png", "box_in_scene.png"}) {
    const auto photograph = read_image(folder / name);
    if (photograph.ok()) frames.push_back({name, scaled(*photograph, 320, 240)});
  }
  const auto building = read_image(folder / "building.jpg");
  if (!building.ok()) return frames;
  GreyImage middle(320, 240);
  for (int v = 0; v < 240; ++v) std::copy_n(building->view().pixel(270, 180 + v), 320, &middle(0, v));
  frames.push_back({"building_middle", std::move(middle)});
  return frames;
}

const std::vector<Frame>& frames() {
  static const std::vector<Frame> all = make_frames();
  return all;
}

const GreyImage& frame() { return frames().front().image; }

// The circle of windows that a search with this radius goes through.
std::vector<WindowRow> circle(int radius) {
  std::vector<WindowRow> rows;
  for (int v = -radius; v <= radius; ++v) {
    const int half = static_cast<int>(std::sqrt(radius * radius - v * v));
    rows.push_back({radius - half, 2 * half + 1});
  }
  return rows;
}

std::int64_t windows_of(const std::vector<WindowRow>& rows) {
  std::int64_t count = 0;
  for (const WindowRow& row : rows) count += row.count;
  return count;
}

void search(benchmark::State& state, std::int64_t target, int size, int radius) {
  hwy::SetSupportedTargetsForTest(target);
  const ZmssdPatch patch = make_zmssd_patch(frame().view().pixel(100, 100), frame().stride(), size);
  const std::vector<WindowRow> rows = circle(radius);
  std::vector<std::uint32_t> scores(static_cast<std::size_t>(windows_of(rows)));
  int v = 0;
  for (auto _ : state) {
    v = (v + 1) % 100;
    zmssd_search(patch, frame().view().pixel(50, v), frame().stride(), rows.data(), rows.size(),
                 scores.data());
    benchmark::DoNotOptimize(scores.data());
    benchmark::ClobberMemory();
  }
  state.SetItemsProcessed(state.iterations() * windows_of(rows));
  hwy::SetSupportedTargetsForTest(0);
}

void search_plain(benchmark::State& state, int size, int radius) {
  const std::uint8_t* patch = frame().view().pixel(100, 100);
  const std::vector<WindowRow> rows = circle(radius);
  for (auto _ : state) {
    int v = 0;
    for (const WindowRow& row : rows) {
      const std::uint8_t* window = frame().view().pixel(50 + row.first, v++);
      for (int u = 0; u < row.count; ++u)
        benchmark::DoNotOptimize(
            reference::zmssd(patch, frame().stride(), window + u, frame().stride(), size));
    }
  }
  state.SetItemsProcessed(state.iterations() * windows_of(rows));
}

void corners(benchmark::State& state, const GreyImage& image, int arc) {
  vision::CornerDetector detector({.threshold = 20, .arc = arc});
  std::size_t found = 0;
  for (auto _ : state) found = detector.detect(image).size();
  state.counters["corners"] = static_cast<double>(found);
}

// One landmark: an ellipse of 5 px standard deviation, and its peak.
void find_landmark(benchmark::State& state, vision::MatchScore match) {
  const ImageView image = frames().back().image;
  vision::Search search({.match = match});
  const vision::Patch patch = *vision::cut_patch(image, 160, 120, 16);
  const Eigen::Matrix2d S{{25.0, 5.0}, {5.0, 25.0}};
  for (auto _ : state) benchmark::DoNotOptimize(search.find(image, patch, {161.3, 118.6}, S));
  state.SetItemsProcessed(state.iterations() * search.windows());
}

void find_subpixel_peak(benchmark::State& state) {
  const ImageView image = frames().back().image;
  const vision::Patch patch = *vision::cut_patch(image, 160, 120, 16);
  for (auto _ : state) benchmark::DoNotOptimize(vision::find_peak(image, patch, 160, 120, 3.0));
}

void warp(benchmark::State& state) {
  const vision::ReferencePatch reference = *vision::cut_reference(frames().back().image, 160, 120);
  const Eigen::Matrix2d A{{0.9, 0.1}, {-0.1, 1.1}};
  for (auto _ : state) benchmark::DoNotOptimize(vision::warp_patch(reference, A, 16));
}

// What a tracker is asked in an image: 20 landmarks and 4 candidates, and corners in two cells.
class TrackedFrame {
 public:
  TrackedFrame(const vision::TrackerOptions& options, const vision::SearchOptions& search, int threads)
      : tracker_(options, search, camera_, threads) {
    for (int tries = 0; expectations_.size() < kFeatures && tries < 100; ++tries) learn_corners();
    for (std::size_t k = 0; k < expectations_.size() / 6; ++k) make_candidate(expectations_[k]);
  }

  void track() {
    tracker_.track(image_, moved_, expectations_, [](vision::Round, const vision::SearchOutcome& seen) {
      benchmark::DoNotOptimize(seen);
      return Correction{};
    });
  }
  [[nodiscard]] double count(vision::SearchRecord::Result result) const {
    return static_cast<double>(
        std::ranges::count(tracker_.search_records(), result, &vision::SearchRecord::result));
  }
  [[nodiscard]] const FunctionBlocks& blocks() const { return tracker_.blocks(); }

 private:
  static constexpr std::size_t kFeatures = 24;
  static constexpr double kDepth_m = 3.0;

  void learn_corners() {
    const std::vector<Expectation> known = expectations_;
    std::vector<Innovation> taken;
    tracker_.track(image_, {}, known, [&](vision::Round round, const vision::SearchOutcome& observations) {
      if (round == vision::Round::kLandmarks) return Correction{};
      for (const Observation& seen : observations.found) {
        const auto& place = std::get<Pixel>(seen.value);
        if (expectations_.size() == kFeatures) break;
        taken.push_back({*seen.id, Outcome::kAdded});
        expectations_.push_back(expectation(*seen.id, {place.u_px, place.v_px}));
      }
      return Correction{taken, {}};
    });
  }
  [[nodiscard]] Expectation expectation(LandmarkId id, const Eigen::Vector2d& pixel) const {
    const CameraPose pose = camera_.pose({});
    const Eigen::Vector2d xy = camera_.ray(pixel)->xy;
    return {.id = id,
            .predicted_px = pixel + Eigen::Vector2d(1.3, -0.9),
            .S = Eigen::Matrix2d{{25.0, 5.0}, {5.0, 25.0}},
            .p_world_m = pose.p_world_camera +
                         kDepth_m * pose.R_camera_world.transpose() * Eigen::Vector3d(xy.x(), xy.y(), 1.0),
            .information_nats = 4.0};
  }
  static void make_candidate(Expectation& e) {
    e.candidate = true;
    e.S = Eigen::Matrix2d{{400.0, 0.0}, {0.0, 4.0}};
  }

  GreyImage image_ = frames().back().image;
  Camera camera_;
  Pose2 moved_{0.01, 0.0, 0.0};
  vision::Tracker tracker_;
  std::vector<Expectation> expectations_;
};

void track_frame(benchmark::State& state, const vision::TrackerOptions& options,
                 const vision::SearchOptions& search) {
  TrackedFrame frame(options, search, 1);
  for (auto _ : state) frame.track();
  state.counters["found"] = frame.count(vision::SearchRecord::Result::kFound);
  state.counters["new"] = frame.count(vision::SearchRecord::Result::kNew);
  for (const FunctionBlocks::Row& row : frame.blocks().rows())
    state.counters[std::string(row.name) + " us"] =
        1e6 * to_seconds(row.total) / static_cast<double>(row.calls);
}

vision::TrackerOptions usual_tracker() { return {.new_corners = {.wanted = 36, .max_new = 2}}; }

vision::TrackerOptions article_tracker(kernels::Instructions instructions) {
  vision::TrackerOptions options = usual_tracker();
  options.finder = {.warp = false, .subpixel = false};
  options.instructions = instructions;
  return options;
}

#ifdef WAYMARK_WITH_OPENCV
void corners_opencv(benchmark::State& state, const GreyImage& image) {
  cv::setNumThreads(1);
  const cv::Mat pixels(image.height_px(), image.width_px(), CV_8U, const_cast<std::uint8_t*>(image.data()));
  std::vector<cv::KeyPoint> points;
  for (auto _ : state) cv::FAST(pixels, points, 20, true, cv::FastFeatureDetector::TYPE_9_16);
  state.counters["corners"] = static_cast<double>(points.size());
}

// All windows of a 64 x 64 search, as cv::matchTemplate scores them.
void match_template_opencv(benchmark::State& state) {
  cv::setNumThreads(1);
  const GreyImage& image = frame();
  const cv::Mat pixels(image.height_px(), image.width_px(), CV_8U, const_cast<std::uint8_t*>(image.data()));
  const cv::Mat area = pixels(cv::Rect(50, 50, 79, 79)), patch = pixels(cv::Rect(100, 100, 16, 16));
  cv::Mat scores;
  for (auto _ : state) cv::matchTemplate(area, patch, scores, cv::TM_CCOEFF);
  state.SetItemsProcessed(state.iterations() * 64 * 64);
}
#endif

void register_corners() {
  for (const Frame& f : frames()) {
    for (const int arc : {9, 12})
      benchmark::RegisterBenchmark(("corners/" + std::to_string(arc) + "/" + f.name).c_str(), corners,
                                   f.image, arc);
#ifdef WAYMARK_WITH_OPENCV
    benchmark::RegisterBenchmark(("corners_opencv/9/" + f.name).c_str(), corners_opencv, f.image);
#endif
  }
}

void register_searches() {
  for (const int size : {16, 13, 11, 9, 8}) {
    for (const int radius : {4, 12, 28}) {
      const std::string suffix = "/" + std::to_string(size) + "/" + std::to_string(radius);
      for (const std::int64_t target : hwy::SupportedAndGeneratedTargets())
        benchmark::RegisterBenchmark(("zmssd/" + std::string(hwy::TargetName(target)) + suffix).c_str(),
                                     search, target, size, radius);
      benchmark::RegisterBenchmark(("zmssd/plain" + suffix).c_str(), search_plain, size, radius);
    }
  }
#ifdef WAYMARK_WITH_OPENCV
  benchmark::RegisterBenchmark("match_template_opencv/16/64", match_template_opencv);
#endif
}

const bool kRegistered = [] {
  register_searches();
  register_corners();
  benchmark::RegisterBenchmark("find_landmark/map", find_landmark, vision::MatchScore::kMap);
  benchmark::RegisterBenchmark("find_landmark/article", find_landmark, vision::MatchScore::kArticle);
  benchmark::RegisterBenchmark("find_subpixel_peak", find_subpixel_peak);
  benchmark::RegisterBenchmark("warp", warp);
  benchmark::RegisterBenchmark("tracker_frame", track_frame, usual_tracker(), vision::SearchOptions{});
  const vision::SearchOptions article{.match = vision::MatchScore::kArticle};
  benchmark::RegisterBenchmark("tracker_frame/article", track_frame, article_tracker(Instructions::kSimd),
                               article);
  benchmark::RegisterBenchmark("tracker_frame/article_scalar", track_frame,
                               article_tracker(Instructions::kScalar), article);
  return true;
}();

}  // namespace
}  // namespace waymark::kernels
