#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "waymark/core/result.hpp"

#include "workbench/bags/message_definition.hpp"

namespace waymark::bag {

/// Which fields of a message are wanted, as paths "pose.pose.position.x"; "" is none, whose values stay
/// empty. Letters may be large or small: ROS 2 writes `k` for what ROS 1 writes `K`.
struct WantedFields {
  std::vector<std::string> numbers;
  std::vector<std::string> texts;  ///< strings, and arrays of bytes
};

/// Takes the wanted fields out of serialized messages, of ROS 1 or CDR, by their definition: by that in the
/// bag, and where it lacks a field or messages do not fit it, by the known ones of the type. A definition
/// that did not fit a message is not used after another one did. Allocates nothing once its columns have
/// grown.
class MessageDecoder {
 public:
  /// An error: no definition has these fields.
  [[nodiscard]] static Result<MessageDecoder> make(const Topic& topic, const WantedFields& wanted);
  /// The same for a type whose fields have had different names: a definition is read by the first of the
  /// `choices` that it has. All have as many numbers and texts.
  [[nodiscard]] static Result<MessageDecoder> make_any(const Topic& topic,
                                                       std::span<const WantedFields> choices);

  /// Reads one message; an error where it fits no definition. Its bytes must outlive the use of texts().
  [[nodiscard]] Result<void> decode(std::string_view bytes);

  /// Why not the definition in the bag but a known one is used; empty: that in the bag is, or there is none.
  [[nodiscard]] const std::string& note() const { return candidates_.front().note; }

  /// Of the wanted number i: one value for a plain field, all values of an array, and one value per element
  /// for a field of an array's elements; there an array's first value stands for it, and NaN for none.
  [[nodiscard]] std::span<const double> numbers(std::size_t i) const { return numbers_[i]; }
  /// The same for texts. An array of bytes is one text.
  [[nodiscard]] std::span<const std::string_view> texts(std::size_t i) const { return texts_[i]; }

  /// The first one; NaN and "" where there is none.
  [[nodiscard]] double number(std::size_t i) const {
    return numbers_[i].empty() ? std::numeric_limits<double>::quiet_NaN() : numbers_[i][0];
  }
  [[nodiscard]] std::string_view text(std::size_t i) const {
    return texts_[i].empty() ? std::string_view{} : texts_[i][0];
  }
  /// The first one if it is a whole number that a size can be, else 0.
  [[nodiscard]] std::uint32_t size(std::size_t i) const {
    const double value = number(i);
    return value >= 0.0 && value <= std::numeric_limits<std::uint32_t>::max()
               ? static_cast<std::uint32_t>(value)
               : 0;
  }

 private:
  /// A field with the column that it goes to.
  struct Node {
    Field field;  // without its own fields
    std::vector<Node> nodes;
    int column = -1;
  };
  class Walk;
  /// What the messages may look like.
  struct Candidate {
    std::vector<Node> nodes;
    std::string note;
  };

  [[nodiscard]] static std::vector<Node> nodes_of(const std::vector<Field>& fields);
  [[nodiscard]] static Result<std::vector<Node>> nodes_with(const std::vector<Field>& fields,
                                                            std::span<const WantedFields> choices);
  [[nodiscard]] static bool assign(std::vector<Node>& nodes, std::string_view path, int column, bool is_text);

  Encoding encoding_ = Encoding::kRos1;
  std::vector<Candidate> candidates_;  // the likeliest first; never empty
  std::vector<std::vector<double>> numbers_;
  std::vector<std::vector<std::string_view>> texts_;
};

}  // namespace waymark::bag
