#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "waymark/core/result.hpp"
#include "waymark/core/stamp.hpp"

namespace waymark::bag {

/// How the messages of a topic are written down.
enum class Encoding { kRos1, kCdr, kOther };

/// A topic as its bag describes it.
struct Topic {
  std::string name;
  std::string type;  ///< "nav_msgs/Odometry", in bags of ROS 2, too
  Encoding encoding = Encoding::kOther;
  std::string definition;  ///< of the type, with those that it is made of; empty: the bag does not tell
  std::int64_t messages = 0;
};

/// What is in a bag.
struct Summary {
  std::string format;  ///< "ROS 1 bag", ...
  std::vector<Topic> topics;
  std::optional<Stamp> first;  ///< when the first message was recorded; empty: there is none
  std::optional<Stamp> last;
};

struct Message {
  std::size_t topic = 0;  ///< its place in Summary::topics
  Stamp recorded;
  std::string_view bytes;  ///< valid until the next one
};

/// A bag of any kind as one stream of messages, in the order in which they were recorded. Memory: a few
/// blocks and the largest message, whatever the size of the bag.
class Reader {
 public:
  Reader() = default;
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;
  virtual ~Reader() = default;

  [[nodiscard]] virtual const Summary& summary() const = 0;

  /// Begins again, with the messages of those topics alone for which `wanted` holds. What holds no such
  /// message is not read where the bag's index tells.
  virtual void rewind(std::vector<bool> wanted) = 0;

  /// The next message; nothing at the end. What is damaged or cut off is passed over and noted.
  [[nodiscard]] virtual std::optional<Message> next() = 0;

  /// What was damaged, one line each.
  [[nodiscard]] virtual std::vector<std::string> notes() const = 0;

  /// Fraction of the bag that has been passed.
  [[nodiscard]] virtual double progress() const = 0;
};

/// "nav_msgs/msg/Odometry", as ROS 2 writes it, is "nav_msgs/Odometry", and so are "nav_msgs::msg::Odometry"
/// of IDL and "nav_msgs::msg::dds_::Odometry_" of recorders below ROS.
[[nodiscard]] std::string plain_type(std::string_view type);

/// The topic's place among `topics`; appended where its like (name, type, encoding) is not there yet.
[[nodiscard]] std::size_t place_topic(std::vector<Topic>& topics, Topic topic);

/// Widens the span from first to last.
void include(Summary& summary, Stamp stamp);

/// Adds a line that is not there yet.
void add_note(std::vector<std::string>& notes, std::string note);

}  // namespace waymark::bag
