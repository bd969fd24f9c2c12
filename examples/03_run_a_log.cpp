// A log through the whole pipeline with a callback on every step: usage 03_run_a_log [LOG]
// LOG is anything that `waymark run` takes; without one it is a simulated drive.

#include <cstdio>
#include <string>

#include <waymark/slam/pipeline.hpp>
#include <workbench/run/config.hpp>
#include <workbench/run/make_filter.hpp>

int main(int argc, char** argv) {
  using namespace waymark;

  const std::string input = argc > 1 ? argv[1] : "sim:figure-eight";
  auto opened = open_input(input, UserSettings{{}, {"filter=fastslam", "fastslam.particles=200"}});
  if (!opened) {
    std::fprintf(stderr, "%s\n", opened.error().message.c_str());
    return 2;
  }
  const Config& config = opened->config;
  auto filter = make_filter(config);
  if (!filter) {
    std::fprintf(stderr, "%s\n", filter.error().message.c_str());
    return 2;
  }

  int corrections = 0;
  Pipeline pipeline(**filter, config.pipeline, config.odometry, config.sensor, config.observe,
                    [&](const Step& step) {
                      if (step.correction == nullptr || ++corrections % 200 != 0) return;
                      const Pose2& pose = step.pose.T_world_robot;
                      std::printf("%8.2f s  (%.2f, %.2f) m  %.1f deg\n", to_seconds(step.stamp), pose.x_m,
                                  pose.y_m, to_degrees(pose.theta_rad));
                    });
  while (true) {
    auto event = opened->source->next();
    if (!event) {
      std::fprintf(stderr, "%s\n", event.error().message.c_str());
      return 2;
    }
    if (!*event) break;
    pipeline.push(std::move(**event));
  }
  pipeline.finish();

  const auto landmarks = (*filter)->snapshot().landmarks;
  std::printf("%zu landmarks, %d corrections\n", landmarks.size(), corrections);
  return landmarks.empty() ? 1 : 0;
}
