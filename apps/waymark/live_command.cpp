#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>

#include <fmt/format.h>

#include "commands.hpp"
#include "filter_flags.hpp"
#include "workbench/live/arcos_stream.hpp"
#include "workbench/live/figures_text.hpp"
#include "workbench/live/line_stream.hpp"
#include "workbench/live/mjpeg_stream.hpp"
#include "workbench/live/monitor_feed.hpp"
#include "workbench/live/pose_publisher.hpp"
#include "workbench/live/probe.hpp"
#include "workbench/live/realtime.hpp"
#include "workbench/live/recorder.hpp"
#include "workbench/live/replay_stream.hpp"
#include "workbench/live/session.hpp"
#include "workbench/logs/files.hpp"
#include "workbench/logs/map_files.hpp"
#include "workbench/logs/tum.hpp"
#include "workbench/report/pages.hpp"
#include "workbench/report/results.hpp"

namespace waymark::app {
namespace {

constexpr double kProbe_s = 5.0;
constexpr std::size_t kMostPoints = 20'000;  // of the path in the report

struct LiveRequest {
  std::string replay;
  double speed = 1.0;
  std::string wheels;
  double ticks_per_turn = 0.0;
  int baud = 115200;
  double unit_mm = 0.485;
  std::string camera;
  double camera_latency_ms = 0.0;
  std::vector<std::string> listen;
  std::string record;
  std::string monitor;
  bool realtime = false;
  bool probe = false;
  std::string publish;
  double for_s = 0.0;
  std::string output = "waymark-live";
  FilterFlags filter;
  SettingsFlags flags;
  Verbosity verbosity;

  [[nodiscard]] UserSettings settings() const {
    UserSettings user = flags.settings();
    filter.add_to(user);
    return user;
  }
};

/// Where events come from, with the config that holds for them.
struct Input {
  Config config;
  LogInfo log{.name = "live", .format = "live"};
  std::unique_ptr<Source> replayed;  ///< null: a robot
  live::SessionClock clock;
  std::vector<std::unique_ptr<live::Stream>> streams;
};

Result<Input> open_replay(const LiveRequest& request) {
  if (!(request.speed > 0.0)) return Error{"--speed must be above 0"};
  auto opened = open_input(request.replay, request.settings());
  if (!opened) return opened.error();
  Input input{std::move(opened->config), opened->source->info(), std::move(opened->source), {}, {}};
  auto stream = std::make_unique<live::ReplayStream>(*input.replayed);
  const auto first = stream->first();
  if (!first) return first.error();
  if (!*first) return Error{fmt::format("{}: the log has no events", request.replay)};
  input.clock = live::SessionClock(**first, request.speed);
  input.streams.push_back(std::move(stream));
  return input;
}

/// Numbers streams as they are opened.
class Streams {
 public:
  explicit Streams(const LiveRequest& request) : request_(request) {}

  /// "arcos:/dev/ttyUSB0" is a Pioneer, anything else our own lines.
  Result<void> add_wheels() {
    if (request_.wheels.empty()) return {};
    constexpr std::string_view kArcos = "arcos:";
    const bool is_arcos = request_.wheels.starts_with(kArcos);
    std::string_view text = request_.wheels;
    if (is_arcos) text.remove_prefix(kArcos.size());
    const std::string full =
        is_arcos && text.starts_with("//") ? fmt::format("tcp:{}", text) : std::string(text);
    const auto address = live::parse_address(full, request_.baud);
    if (!address) return address.error();
    if (is_arcos) {
      streams_.push_back(std::make_unique<live::ArcosStream>(*address, device_++, request_.unit_mm));
      return {};
    }
    if (!(request_.ticks_per_turn > 0.0))
      return Error{"--wheels needs --ticks-per-turn: the counts of an encoder in one turn of its wheel"};
    streams_.push_back(std::make_unique<live::LineStream>(
        *address, live::decode_wheel_lines(request_.ticks_per_turn, device_++)));
    return {};
  }

  Result<void> add_camera(const Config& config) {
    if (request_.camera.empty()) return {};
    const auto address = live::parse_address(request_.camera, request_.baud);
    if (!address) return address.error();
    streams_.push_back(std::make_unique<live::MjpegStream>(
        *address, device_++, duration_from_seconds(1e-3 * request_.camera_latency_ms),
        ImageSize{config.camera.width_px, config.camera.height_px}));
    return {};
  }

  Result<void> add_listeners() {
    for (const std::string& text : request_.listen) {
      const auto address = live::parse_address(text, request_.baud);
      if (!address) return address.error();
      streams_.push_back(std::make_unique<live::LineStream>(*address, live::decode_json_lines(device_)));
      device_ += live::kJsonStreams;
    }
    return {};
  }

  [[nodiscard]] std::vector<std::unique_ptr<live::Stream>> take() { return std::move(streams_); }

 private:
  const LiveRequest& request_;
  std::vector<std::unique_ptr<live::Stream>> streams_;
  std::uint16_t device_ = 0;
};

Result<Input> open_robot(const LiveRequest& request) {
  auto config = resolve_config(request.settings());
  if (!config) return config.error();
  Input input{*std::move(config), {.name = "live", .format = "live"}, nullptr, {}, {}};
  Streams streams(request);
  if (auto added = streams.add_wheels(); !added) return added.error();
  if (auto added = streams.add_camera(input.config); !added) return added.error();
  if (auto added = streams.add_listeners(); !added) return added.error();
  input.streams = streams.take();
  if (input.streams.empty())
    return Error{
        "nothing to listen to: give --replay LOG, or --wheels, --camera and --listen with where they come "
        "from"};
  return input;
}

/// Those of the log, and of streams that brought nothing.
std::vector<std::string> notes_of(const Input& input, const live::SessionFigures& figures) {
  std::vector<std::string> notes;
  if (input.replayed) notes = input.replayed->notes();
  for (const live::StreamSummary& stream : figures.streams)
    if (!stream.fault.empty()) notes.push_back(fmt::format("{}: {}", stream.name, stream.fault));
  return notes;
}

/// What a session writes and sends while it runs.
struct Outputs {
  TumWriter trajectory;
  std::optional<live::PosePublisher> publisher;
  std::unique_ptr<live::Recorder> recorder;
  std::unique_ptr<live::Monitor> monitor;
};

Result<Outputs> open_outputs(const LiveRequest& request, const std::string& session, Config& config,
                             Stamp now) {
  auto trajectory = TumWriter::open(std::filesystem::path(request.output) / "trajectory.tum");
  if (!trajectory) return trajectory.error();
  Outputs outputs{*std::move(trajectory), std::nullopt, nullptr, nullptr};
  if (!request.publish.empty()) {
    auto opened = live::PosePublisher::open(request.publish);
    if (!opened) return opened.error();
    outputs.publisher = *std::move(opened);
  }
  if (!request.record.empty()) {
    auto opened = live::Recorder::open(request.record, session, describe(config).to_yaml(), now);
    if (!opened) return opened.error();
    outputs.recorder = *std::move(opened);
  }
  if (!request.monitor.empty()) {
    auto started = live::Monitor::start(request.monitor, std::string(live_page()));
    if (!started) return started.error();
    outputs.monitor = *std::move(started);
    if (request.verbosity.talks()) fmt::print("monitor: {}\n", outputs.monitor->url());
    std::fflush(stdout);
  }
  return outputs;
}

/// Ends the run, and writes what `waymark run` writes, and live.json.
Result<void> write_session(const LiveRequest& request, Input& input, FilterRun& run,
                           const live::SessionFigures& figures, std::optional<Error> broke_off,
                           std::vector<std::string> notes) {
  const PipelineCounts counts = run.counts();
  auto recording = run.finish(input.log, std::move(notes), std::move(broke_off), true);
  if (!recording) return recording.error();
  RunResult result{
      study::score_run(input.log.name, std::move(input.config), input.log, *std::move(recording)), {}};
  result.metrics = make_metrics(result.input, result.config, result.recording, result.evaluation);
  if (auto written = write_results(result, request.output, command_line(), false); !written) return written;
  const live::ProcessFigures process = live::process_figures();
  const std::string json = to_json(figures, counts, process);
  if (auto written = write_file(std::filesystem::path(request.output) / "live.json", json); !written)
    return written;
  if (request.verbosity.json) fmt::print("{}", json);
  if (request.verbosity.talks()) {
    fmt::print("{}{}", to_text(result.metrics), to_text(figures, counts, process));
    for (const auto& note : result.recording.notes) fmt::print("  note: {}\n", note);
    fmt::print("report: {}/report.html\n", request.output);
  }
  if (result.recording.error) return *result.recording.error;
  return {};
}

/// Hands what a session tells to the outputs, and does what buttons ask for.
class Conductor {
 public:
  Conductor(const LiveRequest& request, Outputs& outputs, const FilterRun& run,
            const live::SessionClock& clock)
      : request_(request), outputs_(outputs), run_(run), clock_(clock), start_(clock.now()) {
    if (outputs.monitor) feed_.emplace(*outputs.monitor, clock);
  }

  [[nodiscard]] live::Listeners listeners() {
    live::Listeners listeners;
    if (outputs_.publisher || outputs_.recorder)
      listeners.pose_of_now = [this](const live::StampedPose& pose) {
        if (outputs_.publisher) outputs_.publisher->send(pose);
        if (outputs_.recorder) outputs_.recorder->add(pose);
      };
    listeners.step = [this](const Step& step) {
      outputs_.trajectory.write(step.stamp, step.pose.T_world_robot);
      if (feed_) feed_->add(step);
    };
    listeners.held = [this](const Event& event) {
      if (outputs_.recorder) outputs_.recorder->hold(event, clock_.now());
      if (feed_) feed_->hold(event);
    };
    listeners.processed = [this](Stamp until) {
      if (outputs_.recorder) outputs_.recorder->process_until(until);
    };
    return listeners;
  }

  /// Ten times a second, on the filter's thread.
  [[nodiscard]] bool keep_going(const live::Session& session) {
    outputs_.trajectory.flush();
    bool stopped =
        interrupted() || (request_.for_s > 0.0 && to_seconds(clock_.now() - start_) >= request_.for_s);
    if (!feed_) return !stopped;
    for (const live::MonitorCommand command : outputs_.monitor->take_commands()) {
      if (command == live::MonitorCommand::kStop) stopped = true;
      if (command == live::MonitorCommand::kMark) write_mark(session);
      if (command == live::MonitorCommand::kSave) save_map_now();
    }
    feed_->update(session, run_, {recording_text(), free_mb(), marks_});
    return !stopped;
  }

  /// What could not be written on the way, one line each.
  [[nodiscard]] const std::vector<std::string>& notes() const { return notes_; }

 private:
  [[nodiscard]] std::filesystem::path file(const char* name) const {
    return std::filesystem::path(request_.output) / name;
  }

  /// A row of marks.csv: when someone said that the robot stood on a mark, and where it was believed to be.
  void write_mark(const live::Session& session) {
    const auto pose = session.pose_of_now();
    if (!pose) return;
    ++marks_;
    if (marks_text_.empty()) marks_text_ = "stamp_s,x_m,y_m,theta_rad\n";
    const Pose2& T = pose->estimate.T_world_robot;
    marks_text_ +=
        fmt::format("{},{:.4f},{:.4f},{:.5f}\n", to_string(pose->stamp), T.x_m, T.y_m, T.theta_rad);
    note(write_file(file("marks.csv"), marks_text_));
  }

  void save_map_now() {
    note(write_map_csv(file("map.csv"), run_.recording().filter->snapshot()));
    note(write_map(file("map.waymark"), run_.recording().filter->save()));
  }

  void note(const Result<void>& written) {
    if (!written) notes_.push_back(written.error().message);
  }

  [[nodiscard]] std::string recording_text() const {
    if (!outputs_.recorder) return "";
    const std::string fault = outputs_.recorder->fault();
    return fmt::format("{}: {:.1f} MB{}", request_.record,
                       1e-6 * static_cast<double>(outputs_.recorder->bytes_written()),
                       fault.empty() ? "" : "; " + fault);
  }

  [[nodiscard]] std::optional<double> free_mb() const {
    std::error_code failed;
    const auto space = std::filesystem::space(request_.output, failed);
    return failed ? std::nullopt : std::optional(1e-6 * static_cast<double>(space.available));
  }

  const LiveRequest& request_;
  Outputs& outputs_;
  const FilterRun& run_;
  live::SessionClock clock_;
  Stamp start_;
  std::optional<live::MonitorFeed> feed_;
  int marks_ = 0;
  std::string marks_text_;
  std::vector<std::string> notes_;
};

/// Says what comes, and what to run on it.
Result<void> run_probe(const LiveRequest& request) {
  auto input = request.replay.empty() ? open_robot(request) : open_replay(request);
  if (!input) return input.error();
  catch_interrupts();
  const auto probed =
      live::probe(input->streams, input->clock, request.for_s > 0.0 ? request.for_s : kProbe_s,
                  [] { return !interrupted(); });
  if (!probed) return probed.error();
  fmt::print("{}run: the same command without --probe, with -o OUT\n", to_text(*probed));
  return {};
}

Result<void> run_live(const LiveRequest& request) {
  if (auto made = ensure_output_folder(request.output); !made) return made;
  auto input = request.replay.empty() ? open_robot(request) : open_replay(request);
  if (!input) return input.error();
  const live::SessionClock clock = input->clock;
  auto outputs = open_outputs(request, input->log.name, input->config, clock.now());
  if (!outputs) return outputs.error();
  const auto run = FilterRun::make(input->config);
  if (!run) return run.error();
  (*run)->keep_at_most(kMostPoints);
  Conductor conductor(request, *outputs, **run, clock);
  live::Session session(**run, input->config, clock, std::move(input->streams), conductor.listeners());
  catch_interrupts();
  const auto refused = request.realtime ? live::enter_realtime() : std::vector<std::string>{};
  const auto ended = session.run([&] { return conductor.keep_going(session); });
  const live::SessionFigures figures = session.figures();
  auto notes = notes_of(*input, figures);
  notes.insert(notes.end(), conductor.notes().begin(), conductor.notes().end());
  notes.insert(notes.end(), refused.begin(), refused.end());
  if (outputs->recorder)
    if (auto closed = outputs->recorder->close(); !closed)
      notes.push_back(fmt::format("recording: {}", closed.error().message));
  if (auto closed = outputs->trajectory.close(); !closed) return closed;
  return write_session(request, *input, **run, figures, ended ? std::optional<Error>{} : ended.error(),
                       std::move(notes));
}

}  // namespace

void add_live(CLI::App& app, Work& work) {
  auto* command =
      app.add_subcommand("live", "Run a filter on a robot: odometry and observations in, pose out");
  auto request = std::make_shared<LiveRequest>();
  command
      ->add_option("--replay", request->replay,
                   "in place of a robot: a log folder, a ROS bag, a published data set, or sim:SCENARIO")
      ->type_name("LOG");
  command->add_option("--speed", request->speed, "of the replay; 1 is the pace of the log")->type_name("X");
  command
      ->add_option(
          "--wheels", request->wheels,
          "encoder lines (docs/live.md): a serial port, tcp://HOST:PORT, udp://HOST:PORT, a FIFO or -")
      ->type_name("FROM");
  command
      ->add_option("--ticks-per-turn", request->ticks_per_turn, "counts of an encoder per turn of its wheel")
      ->type_name("N");
  command
      ->add_option(
          "--unit-mm", request->unit_mm,
          "of the distances that a Pioneer tells (--wheels arcos:/dev/ttyUSB0 or arcos://HOST:PORT); "
          "DistConvFactor of its parameter file, default 0.485")
      ->type_name("MM");
  command
      ->add_option("--camera", request->camera,
                   "motion JPEG from http://HOST:PORT/PAGE, tcp://HOST:PORT, a FIFO or a file")
      ->type_name("FROM");
  command
      ->add_option("--camera-latency", request->camera_latency_ms,
                   "ms from exposure to arrival, where the camera stamps nothing")
      ->type_name("MS");
  command
      ->add_option("--record", request->record,
                   "record the session; `waymark run` of the file gives the same path and map")
      ->type_name("FILE.mcap");
  command
      ->add_option(
          "--monitor", request->monitor,
          "show the session on a page at HOST:PORT (127.0.0.1:8080 for this machine, 0.0.0.0:8080 for "
          "a phone beside the robot: the printed address then has a token)")
      ->type_name("HOST:PORT");
  command->add_flag("--probe", request->probe,
                    "only listen for 5 s (or --for), and say what comes: kind, rate, jitter, age, lost");
  command->add_flag("--realtime", request->realtime,
                    "lock memory and schedule first (root, or limits for rtprio and memlock)");
  command->add_option("--baud", request->baud, "of serial ports (default 115200)")->type_name("N");
  command
      ->add_option(
          "--listen", request->listen,
          "lines of JSON with odometry, gyro or observations (docs/live.md): as --wheels; may be given "
          "several times")
      ->type_name("FROM");
  command->add_option("--publish", request->publish, "where to send the pose of now: udp://HOST:PORT")
      ->type_name("TO");
  command->add_option("--for", request->for_s, "seconds after which to end; else Ctrl-C ends")
      ->type_name("S");
  command->add_option("-o,--output", request->output, "folder for the results (default waymark-live)")
      ->type_name("OUT");
  request->filter.add_to(*command);
  request->flags.add_to(*command);
  add_verbosity(*command, request->verbosity);
  command->footer(
      "Examples:\n"
      "  waymark live --replay sim:marker-room -o out\n"
      "  waymark live --wheels /dev/ttyACM0 --ticks-per-turn 1440 --listen udp://127.0.0.1:9100 \\\n"
      "    --config robot.yaml --publish udp://127.0.0.1:9200 -o out\n"
      "  my-detector | waymark live --listen - -o out\n\n"
      "Ends with Ctrl-C. Writes what `waymark run` writes, and live.json: latencies, and what each stream\n"
      "brought and lost. trajectory.tum grows as the robot drives.");
  command->callback([&work, request] {
    work = [request] { return request->probe ? run_probe(*request) : run_live(*request); };
  });
}

}  // namespace waymark::app
