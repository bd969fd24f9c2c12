#include "workshop/figures/desk.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "waymark/core/function_blocks.hpp"
#include "waymark/vision/corners.hpp"
#include "waymark/vision/landmark_finder.hpp"
#include "waymark/vision/new_corners.hpp"

#include "workbench/eval/median.hpp"
#include "workbench/logs/files.hpp"
#include "workbench/logs/image_file.hpp"
#include "workbench/report/article_times.hpp"
#include "workbench/report/base64.hpp"
#include "workshop/figures/desk_search.hpp"
#include "workshop/figures/homography.hpp"
#include "workshop/figures/line_chart.hpp"

namespace waymark {
namespace {

namespace fs = std::filesystem;

constexpr double kConsensus_px = 1.5;
constexpr int kTrail = 15;     // images over which a place is drawn
constexpr int kLongLife = 30;  // images: one second

struct DeskRequest {
  std::string folder;
  std::string drawing;
  int frames = 100000;
};

/// A patch, turned and scaled as the images were since it was cut, and where it has been.
struct Followed {
  vision::Appearance appearance;
  std::vector<Eigen::Vector2d> places;              ///< image by image
  std::size_t cut_in = 0;                           ///< number of the first image
  Eigen::Matrix2d A = Eigen::Matrix2d::Identity();  ///< d(pixel now)/d(pixel then)
  bool ended = false;
  bool left = false;  ///< the image, so that it could not be found
};

/// What one image showed.
struct Frame {
  std::size_t corners = 0;
  std::size_t sought = 0;
  std::size_t found = 0;
  std::size_t agreeing = 0;
  std::size_t young = 0;         ///< sought that were cut in the image before
  std::size_t young_found = 0;   ///< of those
  Duration all_corners_took{0};  ///< of the whole image
  Duration new_corners_took{0};  ///< of the cells where some are wanted, as the tracker looks
  Duration matching_took{0};
};

/// Follows patches from image to image by the motion that they had before.
class Follower {
 public:
  Follower(int width_px, int height_px)
      : finder_(desk_finder(width_px, height_px)), new_corners_(desk_corners(width_px, height_px)) {}

  void see(const GreyImage& image) {
    Frame& frame = frames_.emplace_back();
    const Duration start = thread_cpu_time();
    frame.corners = detector_.detect(image).size();
    frame.all_corners_took = thread_cpu_time() - start;
    judge(follow(image, frame), frame);
    cut_new(image, frame);
  }

  [[nodiscard]] const std::vector<Frame>& frames() const { return frames_; }
  [[nodiscard]] const std::vector<Followed>& patches() const { return patches_; }

 private:
  /// Those that were found.
  std::vector<Followed*> follow(const GreyImage& image, Frame& frame) {
    std::vector<Followed*> found;
    const Duration start = thread_cpu_time();
    for (Followed& each : patches_) {
      if (each.ended) continue;
      const bool is_young = each.places.size() == 1;
      const vision::SearchResult finding = search_for(each, image);
      each.ended = finding.result != vision::SearchRecord::Result::kFound;
      each.left = finding.result == vision::SearchRecord::Result::kNotTried;
      if (each.left) continue;
      ++frame.sought;
      frame.young += is_young;
      if (each.ended) continue;
      frame.young_found += is_young;
      each.places.push_back(finding.pixel);
      found.push_back(&each);
    }
    frame.matching_took = thread_cpu_time() - start;
    frame.found = found.size();
    return found;
  }

  vision::SearchResult search_for(Followed& each, const GreyImage& image) {
    const std::size_t n = each.places.size();
    const Eigen::Vector2d motion = n > 1 ? each.places[n - 1] - each.places[n - 2] : motion_;
    static_cast<void>(each.appearance.patch.seen_under(each.A));
    return finder_.search_for(
        {.predicted_px = each.places.back() + motion, .S = desk_prediction_covariance()}, image, {},
        each.appearance);
  }

  void judge(const std::vector<Followed*>& found, Frame& frame) {
    std::vector<PlacePair> pairs;
    std::vector<double> du, dv;
    for (const Followed* each : found) {
      const std::size_t n = each->places.size();
      pairs.push_back({each->places[n - 2], each->places[n - 1]});
      du.push_back(pairs.back().to.x() - pairs.back().from.x());
      dv.push_back(pairs.back().to.y() - pairs.back().from.y());
    }
    const Consensus consensus = find_homography(pairs, kConsensus_px);
    for (std::size_t i = 0; i < found.size(); ++i)
      found[i]->A = consensus.derivative(pairs[i].from) * found[i]->A;
    frame.agreeing = consensus.size();
    motion_ = {eval::median(du).value_or(0.0), eval::median(dv).value_or(0.0)};
  }

  void cut_new(const GreyImage& image, Frame& frame) {
    std::vector<Eigen::Vector2d> places;
    for (const Followed& each : patches_)
      if (!each.ended) places.push_back(each.places.back());
    const Duration start = thread_cpu_time();
    const auto corners = find_more(new_corners_, image, places);
    frame.new_corners_took = thread_cpu_time() - start;
    for (const vision::Corner& corner : corners)
      if (const auto patch = vision::cut_reference(image, corner.u, corner.v))
        patches_.push_back({.appearance = {.seen_from = {}, .patch = {*patch, kDeskPatch_px}},
                            .places = {Eigen::Vector2d(corner.u, corner.v)},
                            .cut_in = frames_.size() - 1});
  }

  vision::LandmarkFinder finder_;
  vision::CornerDetector detector_;
  vision::NewCorners new_corners_;
  std::vector<Frame> frames_;
  std::vector<Followed> patches_;
  Eigen::Vector2d motion_ = Eigen::Vector2d::Zero();  ///< of the image as a whole
};

std::size_t total(const std::vector<Frame>& frames, std::size_t Frame::*member) {
  std::size_t all = 0;
  for (const Frame& frame : frames) all += frame.*member;
  return all;
}

double median_us(const std::vector<Frame>& frames, Duration Frame::*member) {
  std::vector<double> all;
  for (const Frame& frame : frames) all.push_back(1e6 * to_seconds(frame.*member));
  return eval::median(all).value_or(NAN);
}

double percent(std::size_t part, std::size_t all) {
  return 100.0 * static_cast<double>(part) / static_cast<double>(all);
}

/// Of the patches that could be followed for so long, since they neither left the image before nor did the
/// images end, those that were.
double lived_percent(const Follower& follower, std::size_t images) {
  std::size_t able = 0;
  std::size_t did = 0;
  for (const Followed& each : follower.patches()) {
    const bool did_live = each.places.size() >= images;
    const bool was_cut_short = each.left || each.cut_in + images > follower.frames().size();
    able += did_live || !was_cut_short;
    did += did_live;
  }
  return percent(did, able);
}

double median_life(const Follower& follower) {
  std::vector<double> lives;
  for (const Followed& each : follower.patches()) lives.push_back(static_cast<double>(each.places.size()));
  return eval::median(lives).value_or(NAN);
}

void print_block(const char* name, double us, const char* article_block) {
  const double article_us = article_time(article_block)->per_frame_us;
  fmt::print("{:<44}{:>10.0f}{:>12.0f}{:>10.0f}\n", name, us, article_us, article_us / us);
}

void print(const Follower& follower) {
  const auto& frames = follower.frames();
  std::vector<double> corners;
  for (const Frame& frame : frames) corners.push_back(static_cast<double>(frame.corners));
  const std::size_t found = total(frames, &Frame::found);
  fmt::print("{} images, {} patches; FAST-12 corners per image, median {:.0f}\n", frames.size(),
             follower.patches().size(), eval::median(corners).value_or(NAN));
  fmt::print("found in the image after: {:.1f} % of {} new patches, {:.1f} % of all {} looked for\n",
             percent(total(frames, &Frame::young_found), total(frames, &Frame::young)),
             total(frames, &Frame::young), percent(found, total(frames, &Frame::sought)),
             total(frames, &Frame::sought));
  fmt::print("within {} px of one homography from image to image: {:.1f} % of those found\n", kConsensus_px,
             percent(total(frames, &Frame::agreeing), found));
  fmt::print("followed without a gap: median {:.0f} images; {:.0f} % for {} or more, {:.0f} % for {}\n",
             median_life(follower), lived_percent(follower, kLongLife), kLongLife,
             lived_percent(follower, 3 * kLongLife), 3 * kLongLife);
  Duration matching{0};
  for (const Frame& frame : frames) matching += frame.matching_took;
  const double per_search_us =
      1e6 * to_seconds(matching) / static_cast<double>(total(frames, &Frame::sought));
  const double windows = vision::Search().expected_windows(desk_prediction_covariance());
  fmt::print("\n{:<44}{:>10}{:>12}{:>10}\n", "thread CPU per image, median, us", "here", "article", "times");
  print_block("FB2 corners, whole image", median_us(frames, &Frame::all_corners_took), "FB2");
  print_block("FB2 corners, cells where they are wanted", median_us(frames, &Frame::new_corners_took), "FB2");
  print_block("FB4 match", median_us(frames, &Frame::matching_took), "FB4");
  fmt::print(
      "FB4: {:.1f} us for one patch with its peak, {:.4f} us for one of its {:.0f} windows; article {} us "
      "for "
      "one of {:.0f} an image\n",
      per_search_us, per_search_us / windows, windows, article_time("FB4")->per_call_us,
      article_time("FB4")->calls_per_frame);
}

/// The image, and the patches in it with the way that they have come.
Result<std::string> draw_trails(const Follower& follower, std::size_t number, const GreyImage& image) {
  const auto png = encode_png(image.view());
  if (!png) return png.error();
  std::string svg = fmt::format("<image width=\"{}\" height=\"{}\" href=\"data:image/png;base64,{}\"/>\n",
                                image.width_px(), image.height_px(), base64(*png));
  for (const Followed& each : follower.patches()) {
    if (each.cut_in > number || each.cut_in + each.places.size() <= number) continue;
    const std::size_t last = number - each.cut_in;
    std::string way;
    for (std::size_t k = last < kTrail ? 0 : last - kTrail; k <= last; ++k)
      way += fmt::format("{:.1f},{:.1f} ", each.places[k].x(), each.places[k].y());
    svg += fmt::format(
        "<polyline points=\"{}\" fill=\"none\" stroke=\"#ffd500\"/><circle cx=\"{:.1f}\" cy=\"{:.1f}\" "
        "r=\"2.5\" fill=\"#e8112d\"/>\n",
        way, each.places[last].x(), each.places[last].y());
  }
  return svg;
}

std::vector<double> series(const std::vector<Frame>& frames, double (*value)(const Frame&)) {
  std::vector<double> values;
  for (const Frame& frame : frames) values.push_back(value(frame));
  return values;
}

/// Patches that lived for 1, 2, ... images or more, in percent of those that could have.
std::vector<double> survival(const Follower& follower) {
  std::vector<double> percents;
  for (std::size_t images = 1; 2 * images <= follower.frames().size(); ++images)
    percents.push_back(lived_percent(follower, images));
  return percents;
}

Result<std::string> draw(const Follower& follower, const std::vector<fs::path>& files) {
  constexpr int kPanels = 3;
  constexpr int kWidth = 340;
  const auto& frames = follower.frames();
  std::string svg =
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 1020 680\" font-family=\"sans-serif\" "
      "font-size=\"12\">\n<rect width=\"1020\" height=\"680\" fill=\"white\"/>\n";
  for (int panel = 0; panel < kPanels; ++panel) {
    const std::size_t number = (2 * static_cast<std::size_t>(panel) + 1) * frames.size() / (2 * kPanels);
    const auto image = read_image(files[number]);
    if (!image) return image.error();
    const auto trails = draw_trails(follower, number, *image);
    if (!trails) return trails.error();
    svg +=
        fmt::format("<g transform=\"translate({},10)\">{}<text y=\"256\" fill=\"#222\">image {}</text></g>\n",
                    10 + panel * kWidth, *trails, number);
  }
  const std::vector<LineChart> charts{
      {"FAST-12 corners", series(frames, [](const Frame& f) { return static_cast<double>(f.corners); })},
      {"patches looked for", series(frames, [](const Frame& f) { return static_cast<double>(f.sought); })},
      {"found, % of those looked for",
       series(frames, [](const Frame& f) { return f.sought > 0 ? percent(f.found, f.sought) : 100.0; })},
      {"within 1.5 px of one homography, % of those found",
       series(frames, [](const Frame& f) { return f.found > 0 ? percent(f.agreeing, f.found) : 100.0; })},
      {"followed for so many images or more, %", survival(follower)},
      {"FB4 match, us", series(frames, [](const Frame& f) { return 1e6 * to_seconds(f.matching_took); })}};
  for (std::size_t k = 0; k < charts.size(); ++k)
    svg += fmt::format("<g transform=\"translate({},{})\">{}</g>\n", 10 + static_cast<int>(k % 3) * kWidth,
                       290 + 200 * (k / 3), to_svg(charts[k]));
  return svg + "</svg>\n";
}

Result<void> follow_over(const DeskRequest& request) {
  auto files = desk_images(request.folder);
  if (!files) return files.error();
  files->resize(std::min(files->size(), static_cast<std::size_t>(request.frames)));
  std::optional<Follower> follower;
  std::optional<ImageSize> size;
  for (const fs::path& file : *files) {
    const auto image = read_image(file, size);
    if (!image) return image.error();
    size = {image->width_px(), image->height_px()};
    if (!follower) follower.emplace(size->width_px, size->height_px);
    follower->see(*image);
  }
  print(*follower);
  if (request.drawing.empty()) return {};
  const auto drawing = draw(*follower, *files);
  return drawing ? write_file(request.drawing, *drawing) : Result<void>(drawing.error());
}

int desk(const DeskRequest& request) {
  const auto done = follow_over(request);
  if (!done) fmt::print(stderr, "{}\n", done.error().message);
  return done ? 0 : 1;
}

}  // namespace

void add_desk(CLI::App& app, int& status) {
  auto* command = app.add_subcommand("desk", "corners and patches in images of a hand-held camera");
  auto request = std::make_shared<DeskRequest>();
  command->add_option("folder", request->folder, "monoslam-desk: a folder with images in frames/")
      ->required();
  command->add_option("--frames", request->frames, "use so many")->check(CLI::Range(2, 100000));
  command->add_option("-o,--output", request->drawing, "draw it as well")->type_name("FILE.svg");
  command->callback([request, &status] { status = desk(*request); });
}

}  // namespace waymark
