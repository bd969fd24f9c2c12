// Finding ArUco markers in photographs and in a rendered room, beside OpenCV where it is installed.

#include <filesystem>
#include <string>
#include <vector>

#include <benchmark/benchmark.h>

#include "waymark/markers/aruco_detector.hpp"

#include "workbench/logs/image_file.hpp"
#include "workbench/sim/simulation.hpp"
#ifdef WAYMARK_WITH_OPENCV
#include "markers/opencv_aruco.hpp"
#endif

namespace waymark {
namespace {

struct Photograph {
  std::string name;
  std::string dictionary;
  GreyImage image;
};

/// Images of two laps in a room.
std::vector<Photograph> room() {
  std::vector<Photograph> images;
  sim::SimOptions options = *sim::scenario("marker-room");
  options.camera_simulator.rate_hz = 0.75;
  const auto simulation = sim::Simulation::make("room", options, 1);
  for (auto event = (*simulation)->next(); event && *event; event = (*simulation)->next()) {
    const auto* image = std::get_if<Image>(&(*event)->content);
    if (image != nullptr) images.push_back({"room", "4x4_50", *image->pixels});
  }
  return images;
}

std::vector<Photograph> photographs(const std::filesystem::path& folder) {
  std::vector<Photograph> all;
  for (const auto& [name, dictionary] :
       {std::pair("singlemarkersoriginal.jpg", "6x6_250"), std::pair("choriginal.jpg", "6x6_250"),
        std::pair("tag_01_d7_14cm.png", "5x5_1000"), std::pair("tag_245-246_d7_14cm.png", "5x5_1000"),
        std::pair("arucoboard.png", "6x6_1000")})
    if (auto image = read_image(folder / name)) all.push_back({name, dictionary, *std::move(image)});
  return all;
}

/// Time per image; the counter is how many markers it finds in all of them.
template <class Detector>
void detect(benchmark::State& state, Detector& detector, const std::vector<Photograph>& images) {
  std::size_t found = 0;
  for (auto _ : state) {
    found = 0;
    for (const Photograph& frame : images) found += detector.detect(frame.image).size();
  }
  state.counters["markers"] = static_cast<double>(found);
  state.counters["per image"] =
      benchmark::Counter(static_cast<double>(state.iterations()) * static_cast<double>(images.size()),
                         benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

void register_images(const std::vector<Photograph>& images) {
  const Photograph& first = images.front();
  const auto dictionary = *markers::find_marker_dictionary(first.dictionary);
  const std::string name = first.name + "/" + std::to_string(first.image.width_px()) + "x" +
                           std::to_string(first.image.height_px());
  benchmark::RegisterBenchmark(("aruco/" + name).c_str(), [=](benchmark::State& state) {
    const auto detector = markers::make_aruco_detector(dictionary);
    detect(state, *detector, images);
  })->Unit(benchmark::kMillisecond);
#ifdef WAYMARK_WITH_OPENCV
  benchmark::RegisterBenchmark(("aruco_opencv/" + name).c_str(), [=](benchmark::State& state) {
    test::OpenCvAruco detector(dictionary);
    detect(state, detector, images);
  })->Unit(benchmark::kMillisecond);
#endif
}

const bool kRegistered = [] {
  register_images(room());
  for (const Photograph& each : photographs(std::filesystem::path(WAYMARK_DATA_DIR) / "marker-photos"))
    register_images({each});
  return true;
}();

}  // namespace
}  // namespace waymark
