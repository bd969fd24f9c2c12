#include "workbench/bags/topic_plan.hpp"

#include <algorithm>
#include <functional>
#include <tuple>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "workbench/bags/camera_messages.hpp"
#include "workbench/bags/detection_messages.hpp"
#include "workbench/bags/image_messages.hpp"
#include "workbench/bags/imu_messages.hpp"
#include "workbench/bags/mount_plan.hpp"
#include "workbench/bags/odometry_messages.hpp"
#include "workbench/logs/camera_yaml.hpp"
#include "workbench/logs/number_text.hpp"

namespace waymark::bag {
namespace {

constexpr const char* kNone = "none";
constexpr int kImageOrder = 3;
constexpr Duration kTransformTime = std::chrono::seconds(10);

/// What a topic can be used for.
struct Role {
  const char* what;                       ///< in notes
  const char* key;                        ///< config key that chooses
  int order;                              ///< of events with the same stamp
  std::function<int(const Topic&)> rank;  ///< lower is better, below 0 is unfit
  std::function<Result<TopicReader>(const Topic&)> reader;
};

int outline_rank(const Topic& topic) { return is_outline(topic) ? 0 : -1; }
int camera_rank(const Topic& topic) { return topic.type == kCameraInfo ? 0 : -1; }
int transform_rank(const Topic& topic) {
  return topic.type == kTransforms || topic.type == kOldTransforms ? 0 : -1;
}
bool is_static(const Topic& topic) { return topic.name.ends_with("tf_static"); }
int image_rank(const Topic& topic) {
  return is_image(topic.type) ? (topic.type.ends_with("/Image") ? 0 : 1) : -1;
}
int motion_rank(const Topic& topic) { return odometry_rank(topic.type); }

bool is_readable(const Topic& topic) { return topic.encoding != Encoding::kOther && topic.messages > 0; }

/// "/camera/image_raw/compressed" and "/camera/image_raw" are of "/camera/camera_info".
std::string camera_info_beside(std::string image_topic) {
  constexpr std::string_view kCompressed = "/compressed";
  if (image_topic.ends_with(kCompressed)) image_topic.resize(image_topic.size() - kCompressed.size());
  return image_topic.substr(0, image_topic.rfind('/') + 1) + "camera_info";
}

class Planner {
 public:
  Planner(Reader& bag, const BagOptions& options) : bag_(bag), options_(options) {}

  Result<TopicPlan> run(const std::string& name) {
    plan_.info.name = name;
    plan_.info.format = bag_.summary().format;
    look_at_first_messages();
    look_at_transforms();
    if (auto done = choose_motion(); !done) return done.error();
    if (auto done = choose_imu(); !done) return done.error();
    if (auto done = choose_images(); !done) return done.error();
    if (auto done = settle_mount(); !done) return done.error();
    if (auto done = choose_detections(); !done) return done.error();
    if (auto done = choose_truth(); !done) return done.error();
    settle_info();
    std::vector<bool> wanted(topics().size(), false);
    for (const auto& [place, topic] : plan_.used) wanted[place] = true;
    bag_.rewind(std::move(wanted));
    return std::move(plan_);
  }

 private:
  [[nodiscard]] const std::vector<Topic>& topics() const { return bag_.summary().topics; }

  std::vector<std::size_t> fit(const std::function<int(const Topic&)>& rank) const {
    std::vector<std::size_t> places;
    for (std::size_t i = 0; i < topics().size(); ++i)
      if (is_readable(topics()[i]) && rank(topics()[i]) >= 0) places.push_back(i);
    std::ranges::sort(places, {}, [&](std::size_t i) {
      const Topic& topic = topics()[i];
      return std::tuple(rank(topic), -topic.messages, topic.name);
    });
    return places;
  }

  void look_at_first_messages() {
    std::vector<bool> wanted(topics().size(), false);
    for (const auto& rank : {motion_rank, imu_rank, detection_rank, outline_rank, image_rank, camera_rank})
      for (const std::size_t place : fit(rank)) wanted[place] = true;
    bag_.rewind(wanted);
    auto missing = std::ranges::count(wanted, true);
    while (missing > 0) {
      const auto message = bag_.next();
      if (!message) return;
      missing -= first_.emplace(message->topic, message->bytes).second ? 1 : 0;
    }
  }

  /// All of tf_static; of tf, which goes on and on, the first seconds, in which what is fixed shows.
  void look_at_transforms() {
    read_transforms([](const Topic& topic) { return is_static(topic) ? transform_rank(topic) : -1; },
                    std::nullopt);
    read_transforms([](const Topic& topic) { return is_static(topic) ? -1 : transform_rank(topic); },
                    kTransformTime);
  }

  void read_transforms(const std::function<int(const Topic&)>& rank, std::optional<Duration> time) {
    std::vector<bool> wanted(topics().size(), false);
    for (const std::size_t place : fit(rank)) wanted[place] = true;
    if (std::ranges::count(wanted, true) == 0) return;
    bag_.rewind(std::move(wanted));
    std::optional<Stamp> first;
    while (const auto message = bag_.next()) {
      if (!first) first = message->recorded;
      if (time && message->recorded - *first > *time) return;
      frames_.add(topics()[message->topic], message->bytes);
      uses_[message->topic] = "transforms between frames";
    }
  }

  /// The topic that the user named, or the candidates in the order of their worth.
  Result<std::vector<std::size_t>> candidates(const Role& role, const std::string& named) const {
    auto places = fit(role.rank);
    if (named.empty()) return places;
    if (named == kNone) return std::vector<std::size_t>{};
    const auto found = std::ranges::find_if(
        places, [&](std::size_t i) { return topics()[i].name == named || topics()[i].name == "/" + named; });
    if (found != places.end()) return std::vector{*found};
    std::vector<std::string> names;
    for (const std::size_t place : places) names.push_back(topics()[place].name);
    return Error{fmt::format("{}: {}: the bag has no topic {} with {}; possible are {}", plan_.info.name,
                             role.key, named, role.what,
                             names.empty() ? kNone : fmt::format("{}", fmt::join(names, ", ")))};
  }

  /// The reader of a topic, if it can read the topic's first message.
  Result<TopicReader> try_reader(const Role& role, std::size_t place) const {
    auto reader = role.reader(topics()[place]);
    const auto first = first_.find(place);
    if (!reader || first == first_.end()) return reader;
    if (auto done = reader->decoder.decode(first->second); !done) return done.error();
    if (auto content = reader->content(reader->decoder); !content) return content.error();
    return role.reader(topics()[place]);  // which has counted nothing yet
  }

  /// Takes the best topic that can be read into the plan.
  Result<std::optional<std::size_t>> choose(const Role& role, const std::string& named) {
    const auto places = candidates(role, named);
    if (!places) return places.error();
    for (const std::size_t place : *places) {
      auto reader = try_reader(role, place);
      if (!reader && !named.empty())
        return Error{fmt::format("{}: {}", topics()[place].name, reader.error().message)};
      if (!reader) {
        uses_[place] = "cannot be used: " + reader.error().message;
        plan_.notes.emplace_back(fmt::format("{} is not used for {}: {}", topics()[place].name, role.what,
                                             reader.error().message));
        continue;
      }
      plan_.used.emplace(place, PlannedTopic{*std::move(reader), role.order});
      uses_[place] = role.what;
      note_others(role, *places, place);
      return std::optional(place);
    }
    return std::optional<std::size_t>{};
  }

  void note_others(const Role& role, const std::vector<std::size_t>& places, std::size_t chosen) {
    std::vector<std::string> others;
    for (const std::size_t place : places)
      if (place != chosen && !uses_.contains(place)) others.push_back(topics()[place].name);
    if (!others.empty())
      plan_.notes.push_back(fmt::format("{}: {} is used, not {}; set {} to change that", role.what,
                                        topics()[chosen].name, fmt::join(others, ", "), role.key));
  }

  Result<void> choose_motion() {
    const WheelJoints joints{options_.left_joint, options_.right_joint};
    const Role role{"odometry", "input.odometry_topic", 0, motion_rank,
                    [joints](const Topic& topic) { return odometry_reader(topic, joints); }};
    const auto place = choose(role, options_.odometry_topic);
    if (!place) return place.error();
    if (!*place) return {};
    const Topic& topic = topics()[**place];
    if (topic.type == "nav_msgs/Odometry")
      robot_frames_ = {read_frame(topic, first_[**place], "child_frame_id"),
                       read_frame(topic, first_[**place], "header.frame_id")};
    if (topic.type == "geometry_msgs/Twist")
      plan_.notes.push_back(topic.name +
                            " has no stamps and may contain commands instead of measured motion");
    if (topic.type == "sensor_msgs/JointState")
      plan_.notes.emplace_back(
          "the bag has no wheel sizes: check wheels.left_radius_m, wheels.right_radius_m and wheels.track_m");
    return {};
  }

  /// The IMU beside the odometry, first of all those that a transform has on the robot.
  Result<void> choose_imu() {
    if (plan_.used.empty() && options_.imu_topic.empty()) return {};
    const auto rank = [this](const Topic& topic) {
      constexpr int kBehindKnown = 10;
      const int by_name = imu_rank(topic);
      return by_name < 0 || imu_on_robot(topic) ? by_name : by_name + kBehindKnown;
    };
    const Role role{"the gyro", "input.imu_topic", 0, rank,
                    [this](const Topic& topic) { return imu_reader(topic, imu_vertical(topic)); }};
    const auto place = choose(role, options_.imu_topic);
    if (!place) return place.error();
    if (!*place || imu_on_robot(topics()[**place])) return {};
    const Topic& topic = topics()[**place];
    const Eigen::Vector3d up = imu_vertical(topic);
    plan_.notes.push_back(fmt::format(
        "{}: no tf_static has its frame on the robot; its {} axis is taken as the vertical by gravity",
        topic.name,
        up.x() != 0.0   ? "x"
        : up.y() != 0.0 ? "y"
                        : "z"));
    return {};
  }

  /// Upwards, in the axes of the IMU.
  [[nodiscard]] Eigen::Vector3d imu_vertical(const Topic& topic) const {
    if (const auto T_robot_imu = imu_on_robot(topic)) return T_robot_imu->linear().row(2).transpose();
    const std::string* first = first_of(topic);
    return first != nullptr ? vertical_by_gravity(topic, *first) : Eigen::Vector3d(Eigen::Vector3d::UnitZ());
  }

  [[nodiscard]] std::optional<Eigen::Isometry3d> imu_on_robot(const Topic& topic) const {
    const std::string* first = first_of(topic);
    return first != nullptr ? on_robot(read_frame(topic, *first, "header.frame_id")) : std::nullopt;
  }

  /// The first message of a topic; null: it has none.
  [[nodiscard]] const std::string* first_of(const Topic& topic) const {
    const auto first = std::ranges::find_if(
        first_, [&](const auto& message) { return topics()[message.first].name == topic.name; });
    return first == first_.end() ? nullptr : &first->second;
  }

  Result<void> choose_images() {
    const Role role{"images", "input.image_topic", kImageOrder, image_rank, image_reader};
    const auto place = choose(role, options_.image_topic);
    if (!place) return place.error();
    if (!options_.camera_file.empty()) return take_camera_file();
    return choose_camera(*place ? topics()[**place].name : "");
  }

  Result<void> take_camera_file() {
    const auto camera = read_camera_yaml(options_.camera_file);
    if (!camera) return camera.error();
    plan_.info.settings = lens_settings(*camera);
    return {};
  }

  /// The one beside the images, or the only one.
  Result<void> choose_camera(const std::string& images) {
    const Role role{"the camera", "input.camera_info_topic", 0, camera_rank, {}};
    auto places = candidates(role, options_.camera_info_topic);
    if (!places) return places.error();
    const auto beside = std::ranges::find_if(
        *places, [&](std::size_t i) { return topics()[i].name == camera_info_beside(images); });
    if (beside != places->end()) *places = {*beside};
    if (places->size() == 1 && first_.contains((*places)[0])) {
      take_camera((*places)[0], images);
    } else if (!images.empty()) {
      plan_.notes.push_back(fmt::format(
          "{}: the camera is not calibrated ({}): `waymark calibrate camera PHOTOS -o camera` writes a "
          "calibration, for --set input.camera_file=camera/camera.yaml",
          images,
          places->empty() ? fmt::format("no {}", kCameraInfo)
                          : "there are several CameraInfo topics; choose one by input.camera_info_topic"));
    }
    return {};
  }

  void take_camera(std::size_t place, const std::string& images) {
    const auto of_rectified = [this](std::size_t i) { return outlines_are_rectified(topics()[i].type); };
    const bool rectified = images.empty() ? std::ranges::any_of(fit(outline_rank), of_rectified)
                                          : images.find("image_rect") != std::string::npos;
    const auto camera = read_camera_info(topics()[place], first_[place], rectified);
    if (camera) {
      plan_.info.settings = lens_settings(*camera);
      uses_[place] = "the camera";
    } else {
      plan_.notes.push_back(
          fmt::format("{} has no usable camera calibration: {}; `waymark calibrate camera PHOTOS -o camera` "
                      "writes one, for --set input.camera_file=camera/camera.yaml",
                      topics()[place].name, camera.error().message));
    }
  }

  /// The user's word, else that of the transforms, else the camera looks ahead.
  Result<void> settle_mount() {
    std::optional<std::size_t> place;
    for (const auto& [used, topic] : plan_.used)
      if (topic.order == kImageOrder) place = used;
    for (const auto& rank : {detection_rank, outline_rank})
      if (const auto places = fit(rank); !place && !places.empty()) place = places[0];
    mount_ = options_.mount;
    if (mount_ || !place) return {};
    const std::string& topic = topics()[*place].name;
    auto planned = plan_mount(frames_, robot_frames_, frame_of(*place), topic);
    if (!planned) return Error{fmt::format("{}: {}: {}", plan_.info.name, topic, planned.error().message)};
    camera_frame_ = planned->frame;
    plan_.notes.insert(plan_.notes.end(), planned->notes.begin(), planned->notes.end());
    if (!planned->T_robot_frame) return {};
    mount_ = camera_mount(planned->T_robot_frame->linear(), planned->T_robot_frame->translation());
    add_mount_settings();
    return {};
  }

  /// The frame in which a topic tells what it sees: that nearest to the detection, which may stand in each,
  /// and which the first message may lack.
  std::string frame_of(std::size_t place) {
    constexpr int kMostMessages = 200;
    std::vector<bool> wanted(topics().size(), false);
    wanted[place] = true;
    bag_.rewind(std::move(wanted));
    const Topic& topic = topics()[place];
    for (int i = 0; i < kMostMessages; ++i) {
      const auto message = bag_.next();
      if (!message) break;
      for (const char* field :
           {"markers.header.frame_id", "detections.pose.header.frame_id", "header.frame_id"})
        if (std::string frame = read_frame(topic, message->bytes, field); !frame.empty()) return frame;
    }
    return "";
  }

  /// Where a frame is on the robot.
  [[nodiscard]] std::optional<Eigen::Isometry3d> on_robot(const std::string& frame) const {
    const auto planned = plan_mount(frames_, robot_frames_, frame, "");
    return planned ? planned->T_robot_frame : std::nullopt;
  }

  void add_setting(const char* key, double value) {
    std::string text;
    append_shortest(text, value);
    plan_.info.settings.emplace_back(key, std::move(text));
  }

  void add_mount_settings() {
    add_setting("camera.mount_x_m", mount_->x_m);
    add_setting("camera.mount_y_m", mount_->y_m);
    add_setting("camera.mount_z_m", mount_->z_m);
    add_setting("camera.mount_roll_deg", mount_->roll_deg);
    add_setting("camera.mount_pitch_deg", mount_->pitch_deg);
    add_setting("camera.mount_yaw_deg", mount_->yaw_deg);
  }

  Result<void> choose_detections() {
    if (names_outlines()) return choose_outlines();
    const CameraMount mount = mount_.value_or(CameraMount{});
    const Role role{"observations", "input.observation_topic", 2, detection_rank,
                    [mount](const Topic& topic) { return detection_reader(topic, mount); }};
    const auto place = choose(role, options_.observation_topic);
    if (!place) return place.error();
    has_detections_ = place->has_value();
    if (!has_detections_) return choose_outlines();
    add_setting("sensor.x_m", mount.x_m);
    add_setting("sensor.y_m", mount.y_m);
    add_setting("sensor.yaw_deg", mount.yaw_deg);
    if (!mount_)
      plan_.notes.push_back(fmt::format(
          "no transform has the position of the camera {} on the robot; it is assumed at the robot's origin, "
          "looking ahead; set camera.mount_x_m, camera.mount_yaw_deg etc. if it is not",
          camera_frame_));
    return {};
  }

  /// Images are better than corners that were found in them: what stands around a marker tells how good
  /// they are.
  Result<void> choose_outlines() {
    if (has_images() && !names_outlines()) return {};
    std::erase_if(plan_.used, [](const auto& used) { return used.second.order == kImageOrder; });
    const auto place =
        choose({"corners of markers", "input.observation_topic", 2, outline_rank, outline_reader},
               options_.observation_topic);
    if (!place) return place.error();
    has_outlines_ = place->has_value();
    if (!has_outlines_) return {};
    plan_.info.settings.emplace_back("observe", "markers");
    const std::string dictionary = outline_dictionary(topics()[**place], first_[**place]);
    if (!dictionary.empty()) plan_.info.settings.emplace_back("markers.dictionary", dictionary);
    return {};
  }

  [[nodiscard]] bool names_outlines() const {
    const std::string& named = options_.observation_topic;
    return std::ranges::any_of(fit(outline_rank), [&](std::size_t i) {
      return topics()[i].name == named || topics()[i].name == "/" + named;
    });
  }

  [[nodiscard]] bool has_images() const {
    return std::ranges::any_of(plan_.used, [](const auto& used) { return used.second.order == kImageOrder; });
  }

  Result<void> choose_truth() {
    if (options_.truth_topic.empty()) return {};
    const auto rank = [](const Topic& topic) {
      return topic.type == "nav_msgs/Odometry" || topic.type == "geometry_msgs/PoseStamped" ? 0 : -1;
    };
    const auto place =
        choose({"ground truth", "input.truth_topic", 1, rank, truth_reader}, options_.truth_topic);
    return place ? Result<void>{} : place.error();
  }

  void settle_info() {
    plan_.info.only_pixels = has_images() && !has_detections_;
    if (!has_images() && !has_detections_ && !has_outlines_)
      plan_.notes.emplace_back(
          "the bag has neither images nor detected markers: only dead reckoning is possible");
    std::vector<std::string> unused;
    for (std::size_t i = 0; i < topics().size(); ++i) {
      const auto& [name, type, encoding, definition, messages] = topics()[i];
      const auto use = uses_.find(i);
      plan_.info.topics.push_back({name, type, messages, use == uses_.end() ? "" : use->second});
      const bool known = std::ranges::any_of(
          std::initializer_list<int (*)(const Topic&)>{motion_rank, imu_rank, detection_rank, outline_rank,
                                                       image_rank, camera_rank, transform_rank},
          [&](auto rank) { return rank(topics()[i]) >= 0; });
      if (!known || encoding == Encoding::kOther) unused.push_back(fmt::format("{} ({})", name, type));
    }
    if (!unused.empty())
      plan_.notes.push_back(fmt::format("topics of types that are not used: {}", fmt::join(unused, ", ")));
    const Summary& summary = bag_.summary();
    if (summary.first) plan_.info.recorded_s = to_seconds(*summary.last - *summary.first);
  }

  Reader& bag_;
  const BagOptions& options_;
  TopicPlan plan_;
  std::map<std::size_t, std::string> first_;  // messages
  std::map<std::size_t, std::string> uses_;
  FrameTree frames_;
  RobotFrames robot_frames_;
  std::string camera_frame_;
  std::optional<CameraMount> mount_;
  bool has_detections_ = false;
  bool has_outlines_ = false;
};

}  // namespace

Result<TopicPlan> plan_topics(Reader& bag, const std::string& name, const BagOptions& options) {
  return Planner(bag, options).run(name);
}

}  // namespace waymark::bag
