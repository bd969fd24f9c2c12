#include "workshop/figures/contact_sheet.hpp"

#include <algorithm>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "workbench/logs/image_file.hpp"
#include "workbench/logs/image_loader.hpp"
#include "workbench/run/config.hpp"

namespace waymark {
namespace {

struct SheetRequest {
  std::string input;
  std::string image_file;
  int images = 8;
  int columns = 4;
  std::vector<std::string> settings;
};

/// Calls look(number, image) for every image of the log.
template <class Look>
Result<void> for_each_image(const SheetRequest& request, const Look& look) {
  auto opened = open_input(request.input, {{}, request.settings});
  if (!opened) return opened.error();
  ImageLoader source(std::move(opened->source));
  for (int number = 0;;) {
    const auto event = source.next();
    if (!event) return event.error();
    if (!*event) return {};
    if (const auto* image = std::get_if<Image>(&(**event).content)) look(number++, *image->pixels);
  }
}

void paste(const GreyImage& image, int left, int top, GreyImage& sheet) {
  const int width = std::min(image.width_px(), sheet.width_px() - left);
  for (int v = 0; v < std::min(image.height_px(), sheet.height_px() - top); ++v)
    for (int u = 0; u < width; ++u) sheet(left + u, top + v) = image(u, v);
}

Result<void> write_sheet(const SheetRequest& request) {
  int count = 0;
  if (auto done = for_each_image(request, [&](int, const GreyImage&) { ++count; }); !done) return done;
  if (count < request.images)
    return Error{fmt::format("{}: {} images are wanted, there are {}", request.input, request.images, count)};
  GreyImage sheet;
  int placed = 0;
  const auto place = [&](int number, const GreyImage& image) {
    if (placed == request.images || number != count * placed / request.images) return;
    const int rows = (request.images + request.columns - 1) / request.columns;
    if (placed == 0) sheet = GreyImage(request.columns * image.width_px(), rows * image.height_px());
    paste(image, placed % request.columns * image.width_px(), placed / request.columns * image.height_px(),
          sheet);
    ++placed;
  };
  if (auto done = for_each_image(request, place); !done) return done;
  return write_png(request.image_file, sheet);
}

int make_sheet(const SheetRequest& request) {
  const auto done = write_sheet(request);
  if (!done) fmt::print(stderr, "{}\n", done.error().message);
  return done ? 0 : 1;
}

}  // namespace

void add_contact_sheet(CLI::App& app, int& status) {
  auto request = std::make_shared<SheetRequest>();
  auto* command = app.add_subcommand("sheet", "images of a log side by side in one image");
  command->add_option("input", request->input, "a log, or sim:SCENARIO")->required();
  command->add_option("image", request->image_file, "PNG file to write")->required();
  command->add_option("--images", request->images)->check(CLI::Range(1, 1000));
  command->add_option("--columns", request->columns)->check(CLI::Range(1, 1000));
  command->add_option("--set", request->settings, "config key=value")->allow_extra_args(false);
  command->callback([request, &status] { status = make_sheet(*request); });
}

}  // namespace waymark
