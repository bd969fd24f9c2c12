#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>

#include <fmt/format.h>

#include "calibrate_commands.hpp"
#include "workbench/calibrate/camera_calibration.hpp"
#include "workbench/calibrate/opencv.hpp"
#include "workbench/logs/camera_yaml.hpp"
#include "workbench/logs/files.hpp"
#include "workbench/report/camera_report.hpp"

namespace waymark::app {
namespace {

using calibrate::Board;
using calibrate::BoardView;
using calibrate::CameraCalibration;
using calibrate::Fate;
using calibrate::GridSize;

struct CalibrateCameraRequest {
  std::vector<std::string> inputs;
  std::string output = "waymark-camera";
  calibrate::BoardRequest board;
  SettingsFlags flags;
  Verbosity verbosity;
};

/// The inner corners that most images show.
std::optional<GridSize> guess(const CalibrateCameraRequest& request, const InputOptions& options) {
  auto images = calibrate::open_images(request.inputs, options);
  return images ? calibrate::guess_chessboard(**images) : std::nullopt;
}

std::string name_of(GridSize grid) { return fmt::format("{}x{}", grid.columns, grid.rows); }

Error no_chessboard() {
  return {
      "calibrate camera: no chessboard was found; give its number of inner corners (where four squares meet) "
      "by --corners COLUMNSxROWS, for example 9x6, or use --board charuco"};
}

/// The board that was asked for, or the chessboard that the images show.
Result<Board> settle_board(const CalibrateCameraRequest& request, const InputOptions& options) {
  auto board = calibrate::make_board(request.board);
  if (!board) return board;
  if (const auto opencv = calibrate::load_opencv("calibrate camera"); !opencv) return opencv.error();
  if (board->size() > 0) return board;
  const auto corners = guess(request, options);
  if (!corners) return no_chessboard();
  if (request.verbosity.talks())
    fmt::print("board: the images show {} inner corners; if that is wrong, give --corners\n",
               name_of(*corners));
  board->corners = *corners;
  return board;
}

/// No image shows the board: what do they show?
Error no_board(const CalibrateCameraRequest& request, const InputOptions& options, const Board& board,
               const std::vector<BoardView>& views) {
  const auto unreadable = std::ranges::find(views, Fate::kUnreadable, &BoardView::fate);
  if (unreadable != views.end() &&
      std::ranges::count(views, Fate::kUnreadable, &BoardView::fate) == std::ssize(views))
    return {fmt::format("none of {} images can be read; the first: {}", views.size(), unreadable->why)};
  std::string message = fmt::format("no {} in any of {} images", describe(board), views.size());
  if (board.kind == calibrate::BoardKind::kCharuco) return {message + "; check --squares and --dictionary"};
  if (request.board.corners.empty()) return no_chessboard();
  const auto corners = guess(request, options);
  if (corners && *corners != board.corners)
    return {fmt::format("{}; they seem to show {}: try --corners {}", message, name_of(*corners),
                        name_of(*corners))};
  return {message + "; --corners is the number of points where four squares meet, not of squares"};
}

Result<std::vector<BoardView>> look(const CalibrateCameraRequest& request, const InputOptions& options,
                                    const Board& board) {
  auto finder = calibrate::make_board_finder(board);
  if (!finder) return finder.error();
  auto images = calibrate::open_images(request.inputs, options);
  if (!images) return images.error();
  catch_interrupts();
  ProgressBar bar("finding the board", request.verbosity);
  return calibrate::collect_views(**images, board, **finder, [&bar](double part) {
    bar.show(part);
    return !interrupted();
  });
}

void print_dropped(const CameraCalibration& result) {
  int alike = 0, without_board = 0;
  for (const BoardView& view : result.views) {
    if (view.fate == Fate::kAlike)
      ++alike;
    else if (view.fate == Fate::kNoBoard && !view.is_shown())
      ++without_board;
    else if (view.fate != Fate::kUsed)
      fmt::print("  dropped {}: {}\n", view.name, view.why);
  }
  if (alike + without_board > 0)
    fmt::print("  dropped {} frames similar to others and {} without the board\n", alike, without_board);
}

void print_text(const CameraCalibration& result, const std::string& output) {
  const auto& camera = result.fit.camera;
  const calibrate::Intrinsics sigma = result.fit.sigma();
  fmt::print("{} of {} views of a {}, {} x {} pixels\n", result.used(), result.views.size(),
             describe(result.board), camera.width_px, camera.height_px);
  print_dropped(result);
  fmt::print("  RMS {:.3f} px", result.fit.rms_px);
  if (result.held_out.folds > 0)
    fmt::print("; {:.3f} px on views left out ({} folds)", result.held_out.rms_px, result.held_out.folds);
  fmt::print("\n");
  fmt::print("  fu {:.2f} +- {:.2f}, fv {:.2f} +- {:.2f}, cu {:.2f} +- {:.2f}, cv {:.2f} +- {:.2f} px\n",
             camera.fu_px, sigma[0], camera.fv_px, sigma[1], camera.cu_px, sigma[2], camera.cv_px, sigma[3]);
  if (result.is_weak()) fmt::print("WEAK:\n");
  for (const auto& weakness : result.weaknesses)
    fmt::print("  {}\n    -> {}\n", weakness.what, weakness.advice);
  fmt::print("camera: {0}/camera.yaml\npage: {0}/report.html\n", output);
}

Result<void> write(const CameraCalibration& result, const std::filesystem::path& folder) {
  if (auto made = ensure_output_folder(folder); !made) return made;
  if (auto written = write_file(folder / "camera.yaml", to_camera_yaml(result.fit.camera, "camera"));
      !written)
    return written;
  return write_camera_report({command_line(), result}, folder / "report.html");
}

Result<void> calibrate_camera(const CalibrateCameraRequest& request) {
  const auto config = resolve_config(request.flags.settings());
  if (!config) return config.error();
  if (auto images = calibrate::open_images(request.inputs, config->input); !images) return images.error();
  const auto board = settle_board(request, config->input);
  if (!board) return board.error();
  auto views = look(request, config->input, *board);
  if (!views) return views.error();
  if (std::ranges::all_of(*views, [](const BoardView& view) { return view.corners.empty(); }))
    return no_board(request, config->input, *board, *views);
  const auto result = calibrate::calibrate_camera(*board, *std::move(views));
  if (!result) return result.error();
  if (auto written = write(*result, request.output); !written) return written;
  if (request.verbosity.json) fmt::print("{}\n", camera_json_text(*result));
  if (request.verbosity.talks()) print_text(*result, request.output);
  return {};
}

void add_board(CLI::App& command, calibrate::BoardRequest& board) {
  command.add_option("--board", board.kind, "chessboard (default) or charuco")->type_name("KIND");
  command
      .add_option(
          "--corners", board.corners,
          "number of inner corners of a chessboard, where four squares meet; default: found from the images")
      ->type_name("9x6");
  command.add_option("--squares", board.squares, "number of squares of a ChArUco board")->type_name("5x7");
  command
      .add_option("--square_m", board.square_m,
                  "side of a square, m; needed for the distances on the page, not for the calibration")
      ->type_name("M");
  command.add_option("--marker_m", board.marker_m, "side of a marker of a ChArUco board, m")->type_name("M");
  command
      .add_option("--dictionary", board.dictionary,
                  "marker dictionary of a ChArUco board, for example 5x5_50")
      ->type_name("NAME");
}

}  // namespace

void add_calibrate_camera(CLI::App& calibrate, Work& work) {
  auto* command = calibrate.add_subcommand("camera",
                                           "Calibrate a camera (focal length, principal point, distortion) "
                                           "from images of a chessboard or ChArUco board");
  auto request = std::make_shared<CalibrateCameraRequest>();
  command
      ->add_option("input", request->inputs,
                   "images, folders or file patterns; or one video, ROS bag or log with images")
      ->required()
      ->type_name("IMAGES");
  command
      ->add_option("-o,--output", request->output,
                   "folder for camera.yaml and report.html (default "
                   "waymark-camera)")
      ->type_name("OUT");
  add_board(*command, request->board);
  request->flags.add_to(*command);
  add_verbosity(*command, request->verbosity);
  command->footer(
      "Examples:\n"
      "  waymark calibrate camera photos/ --corners 9x6 --square_m 0.025 -o camera\n"
      "  waymark calibrate camera 'left*.jpg' -o left\n"
      "  waymark calibrate camera drive.bag --set input.image_topic=/camera/image_raw --corners 8x6 -o "
      "camera\n"
      "  waymark calibrate camera board.mp4 --board charuco --squares 5x7 --square_m 0.04 --marker_m 0.02 "
      "--dictionary 5x5_50\n"
      "Then: waymark run LOG --set input.camera_file=camera/camera.yaml for a bag, or copy it into the log "
      "folder.");
  command->callback([&work, request] { work = [request] { return calibrate_camera(*request); }; });
}

}  // namespace waymark::app
