#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "waymark/core/result.hpp"

#include "workbench/bags/reader.hpp"

namespace waymark::bag {

enum class Primitive : std::uint8_t {
  kBool,
  kInt8,
  kUint8,
  kInt16,
  kUint16,
  kInt32,
  kUint32,
  kInt64,
  kUint64,
  kFloat32,
  kFloat64,
  kString
};

/// Bytes of a number; 0 for a string.
[[nodiscard]] std::size_t size_of(Primitive primitive);

/// One value, an array whose length the definition fixes, or one whose length comes with it.
enum class Shape : std::uint8_t { kOne, kFixed, kSequence };

/// A field of a message with all that is in it.
struct Field {
  std::string name;
  Shape shape = Shape::kOne;
  std::uint32_t length = 1;  ///< of a fixed array
  bool is_message = false;
  Primitive primitive = Primitive::kUint8;  ///< where it is no message
  std::vector<Field> fields;                ///< where it is one
};

/// The fields of a topic's messages, by the definition that is stored in the bag: the .msg text of ROS 1 or
/// 2, followed by those of the types that it is made of. Types that are not in there, and all of a topic
/// without definition, are taken from those that every ROS knows. A `time` or `duration` is a message of
/// `sec` and `nanosec`, in ROS 1, too.
[[nodiscard]] Result<std::vector<Field>> parse_definition(const Topic& topic);

/// The .msg text of a standard type in ROS 2; empty for one that is not known.
[[nodiscard]] std::string_view standard_definition(std::string_view type);

}  // namespace waymark::bag
