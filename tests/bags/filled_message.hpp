#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "bags/wire.hpp"
#include "workbench/bags/message_definition.hpp"

namespace waymark::bag::test {

/// The values of a made message, by the path of a field and the number of the outermost list element that it
/// is in.
struct Values {
  std::function<double(const std::string& path, std::uint32_t element)> number;
  std::function<std::string(const std::string& path, std::uint32_t element)> text;
  std::uint32_t elements = 2;  ///< of outermost lists; lists in them have one
};

/// Writes a message of any layout.
class FilledMessage {
 public:
  FilledMessage(Encoding encoding, const Values& values) : wire_(encoding), values_(values) {}

  std::string write(const std::vector<Field>& fields) {
    message(fields, "", 0, false);
    return wire_.bytes();
  }

 private:
  void message(const std::vector<Field>& fields, const std::string& path, std::uint32_t element,
               bool in_list) {
    for (const Field& field : fields) {
      const std::string here = path + field.name;
      std::uint32_t count = field.length;
      if (field.shape == Shape::kSequence) wire_.add(count = in_list ? 1 : values_.elements);
      const bool is_outermost = field.shape == Shape::kSequence && !in_list;
      for (std::uint32_t i = 0; i < count; ++i) {
        const std::uint32_t own = is_outermost ? i : element;
        if (field.is_message)
          message(field.fields, here + ".", own, in_list || field.shape != Shape::kOne);
        else
          value(field.primitive, here, own);
      }
    }
  }

  void value(Primitive primitive, const std::string& path, std::uint32_t element) {
    if (primitive == Primitive::kString) {
      wire_.text(values_.text(path, element));
      return;
    }
    const double number = values_.number(path, element);
    switch (primitive) {
      case Primitive::kBool:
      case Primitive::kUint8:
        wire_.add(static_cast<std::uint8_t>(number));
        break;
      case Primitive::kInt8:
        wire_.add(static_cast<std::int8_t>(number));
        break;
      case Primitive::kInt16:
        wire_.add(static_cast<std::int16_t>(number));
        break;
      case Primitive::kUint16:
        wire_.add(static_cast<std::uint16_t>(number));
        break;
      case Primitive::kInt32:
        wire_.add(static_cast<std::int32_t>(number));
        break;
      case Primitive::kUint32:
        wire_.add(static_cast<std::uint32_t>(number));
        break;
      case Primitive::kInt64:
        wire_.add(static_cast<std::int64_t>(number));
        break;
      case Primitive::kUint64:
        wire_.add(static_cast<std::uint64_t>(number));
        break;
      case Primitive::kFloat32:
        wire_.add(static_cast<float>(number));
        break;
      case Primitive::kFloat64:
      case Primitive::kString:
        wire_.add(number);
        break;
    }
  }

  Wire wire_;
  const Values& values_;
};

}  // namespace waymark::bag::test
