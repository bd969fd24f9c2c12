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
/// 2, followed by those of the types that it is made of. Types that are not in there are taken from the known
/// ones. A `time` or `duration` is a message of `sec` and `nanosec`, in ROS 1, too.
[[nodiscard]] Result<std::vector<Field>> parse_definition(const Topic& topic);

/// Fields that the messages of a topic may have.
struct Layout {
  std::vector<Field> fields;
  bool is_stored = false;  ///< by the definition in the bag, not by a known one
};

/// What the messages of a topic may look like, the likeliest first: by the definition in the bag, where it
/// can be read, and by all known versions of the type. Bags store definitions that are empty, cut off or in
/// another language. An error: there is no layout at all.
[[nodiscard]] Result<std::vector<Layout>> layouts_of(const Topic& topic);

/// Do messages of both have the same bytes? Names do not count.
[[nodiscard]] bool have_same_wire(const std::vector<Field>& a, const std::vector<Field>& b);

/// The known definitions of a type as messages of that encoding have it, in the form of stored ones, the most
/// common version first; none for a type that is not known.
[[nodiscard]] std::vector<std::string_view> known_definitions(std::string_view type, Encoding encoding);

}  // namespace waymark::bag
