#include "workbench/bags/message_decoder.hpp"

#include <algorithm>
#include <cctype>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "workbench/bags/byte_reader.hpp"

namespace waymark::bag {
namespace {

bool same_letters(std::string_view a, std::string_view b) {
  return std::ranges::equal(
      a, b, [](unsigned char x, unsigned char y) { return std::tolower(x) == std::tolower(y); });
}

double number_at(const char* bytes, Primitive primitive, std::endian order) {
  switch (primitive) {
    case Primitive::kBool:
    case Primitive::kUint8:
      return load<std::uint8_t>(bytes, order);
    case Primitive::kInt8:
      return load<std::int8_t>(bytes, order);
    case Primitive::kInt16:
      return load<std::int16_t>(bytes, order);
    case Primitive::kUint16:
      return load<std::uint16_t>(bytes, order);
    case Primitive::kInt32:
      return load<std::int32_t>(bytes, order);
    case Primitive::kUint32:
      return load<std::uint32_t>(bytes, order);
    case Primitive::kInt64:
      return static_cast<double>(load<std::int64_t>(bytes, order));
    case Primitive::kUint64:
      return static_cast<double>(load<std::uint64_t>(bytes, order));
    case Primitive::kFloat32:
      return load<float>(bytes, order);
    case Primitive::kFloat64:
      return load<double>(bytes, order);
    case Primitive::kString:
      break;
  }
  return 0.0;
}

bool is_byte_array(const Field& field) { return field.shape != Shape::kOne && size_of(field.primitive) == 1; }

/// That a known definition is used although the bag has one; empty where it has none.
std::string why_not_stored(const Topic& topic) {
  if (topic.definition.empty()) return "";
  return fmt::format(
      "{}: read by the released definition of {}, because that in the bag lacks a field or does not fit",
      topic.name, topic.type);
}

/// CDR lets a message end in bytes that only fill up.
constexpr std::size_t kMaxPadding = 7;

}  // namespace

/// One pass over one message. Every step takes bytes or is counted, so that no definition can make it long.
class MessageDecoder::Walk {
 public:
  Walk(MessageDecoder& decoder, const std::vector<Node>& nodes, std::string_view bytes)
      : decoder_(decoder),
        nodes_(nodes),
        bytes_(bytes),
        is_cdr_(decoder.encoding_ == Encoding::kCdr),
        steps_left_(4096 + 8 * bytes.size()) {}

  Result<void> run() {
    if (is_cdr_ && !take_encapsulation()) return Error{"it does not start with a header of plain CDR"};
    if (!message(nodes_, false))
      return Error{
          fmt::format("its {} bytes end or are invalid at byte {}, field {}", bytes_.size(), at_, field_)};
    if (bytes_.size() - at_ > (is_cdr_ ? kMaxPadding : 0))
      return Error{fmt::format("it has {} bytes, but only {} by its definition", bytes_.size(), at_)};
    return {};
  }

 private:
  /// 00 00: big-endian, 00 01: little-endian, and two bytes without meaning. Alignment counts from there.
  bool take_encapsulation() {
    if (bytes_.size() < 4 || bytes_[0] != 0 || (bytes_[1] != 0 && bytes_[1] != 1)) return false;
    order_ = bytes_[1] == 0 ? std::endian::big : std::endian::little;
    bytes_.remove_prefix(4);
    return true;
  }

  bool message(const std::vector<Node>& nodes, bool in_array) {
    // A message without fields is one byte in CDR.
    if (nodes.empty() && is_cdr_) return take(1, 1) != nullptr;
    return std::ranges::all_of(nodes, [&](const Node& node) { return field(node, in_array); });
  }

  bool field(const Node& node, bool in_array) {
    if (steps_left_-- == 0) return false;
    field_ = node.field.name;
    std::uint32_t count = node.field.length;
    if (node.field.shape == Shape::kSequence) {
      const char* raw = take(4, 4);
      if (raw == nullptr) return false;
      count = load<std::uint32_t>(raw, order_);
      if (count > bytes_.size() - at_) return false;
    }
    if (node.field.is_message) return messages(node, count, in_array);
    if (node.field.primitive == Primitive::kString) return strings(node, count, in_array);
    return numbers(node, count, in_array);
  }

  bool messages(const Node& node, std::uint32_t count, bool in_array) {
    for (std::uint32_t i = 0; i < count; ++i)
      if (steps_left_-- == 0 || !message(node.nodes, in_array || node.field.shape != Shape::kOne))
        return false;
    return true;
  }

  bool numbers(const Node& node, std::uint32_t count, bool in_array) {
    const std::size_t size = size_of(node.field.primitive);
    const char* raw = count > 0 ? take(size * count, size) : bytes_.data();
    if (raw == nullptr) return false;
    if (node.column < 0) return true;
    const auto column = static_cast<std::size_t>(node.column);
    if (is_byte_array(node.field)) {
      decoder_.texts_[column].emplace_back(raw, count);
      return true;
    }
    auto& values = decoder_.numbers_[column];
    if (in_array && count == 0) values.push_back(std::numeric_limits<double>::quiet_NaN());
    const std::uint32_t kept = in_array ? std::min(count, 1u) : count;
    for (std::uint32_t i = 0; i < kept; ++i)
      values.push_back(number_at(raw + size * i, node.field.primitive, order_));
    return true;
  }

  bool strings(const Node& node, std::uint32_t count, bool in_array) {
    if (in_array && count == 0 && node.column >= 0)
      decoder_.texts_[static_cast<std::size_t>(node.column)].emplace_back();
    for (std::uint32_t i = 0; i < count; ++i) {
      const char* raw_length = take(4, 4);
      if (raw_length == nullptr) return false;
      const auto length = load<std::uint32_t>(raw_length, order_);
      const char* raw = take(length, 1);
      if (raw == nullptr) return false;
      if (node.column < 0 || (in_array && i > 0)) continue;
      std::string_view text(raw, length);
      if (is_cdr_ && text.ends_with('\0')) text.remove_suffix(1);
      decoder_.texts_[static_cast<std::size_t>(node.column)].push_back(text);
    }
    return true;
  }

  /// Null where there are fewer.
  const char* take(std::size_t count, std::size_t alignment) {
    const std::size_t begin = is_cdr_ ? (at_ + alignment - 1) / alignment * alignment : at_;
    if (begin > bytes_.size() || count > bytes_.size() - begin) return nullptr;
    at_ = begin + count;
    return bytes_.data() + begin;
  }

  MessageDecoder& decoder_;
  const std::vector<Node>& nodes_;
  std::string_view bytes_;
  bool is_cdr_;
  std::endian order_ = std::endian::little;
  std::size_t at_ = 0;
  std::size_t steps_left_;
  std::string_view field_;
};

Result<MessageDecoder> MessageDecoder::make(const Topic& topic, const WantedFields& wanted) {
  return make_any(topic, std::span(&wanted, 1));
}

Result<MessageDecoder> MessageDecoder::make_any(const Topic& topic, std::span<const WantedFields> choices) {
  const auto layouts = layouts_of(topic);
  if (!layouts) return layouts.error();
  MessageDecoder decoder;
  decoder.encoding_ = topic.encoding;
  decoder.numbers_.resize(choices[0].numbers.size());
  decoder.texts_.resize(choices[0].texts.size());
  std::vector<const Layout*> taken;
  std::string why_not;
  for (const Layout& layout : *layouts) {
    const bool is_known = std::ranges::any_of(
        taken, [&layout](const Layout* other) { return have_same_wire(other->fields, layout.fields); });
    if (is_known) continue;
    auto nodes = nodes_with(layout.fields, choices);
    if (!nodes) {
      if (why_not.empty()) why_not = nodes.error().message;
      continue;
    }
    decoder.candidates_.push_back({*std::move(nodes), layout.is_stored ? "" : why_not_stored(topic)});
    taken.push_back(&layout);
  }
  if (taken.empty())
    return Error{fmt::format("{}: the definition of {} in the bag {}", topic.name, topic.type, why_not)};
  return decoder;
}

Result<std::vector<MessageDecoder::Node>> MessageDecoder::nodes_with(const std::vector<Field>& fields,
                                                                     std::span<const WantedFields> choices) {
  std::string missing;
  for (const WantedFields& wanted : choices) {
    auto nodes = nodes_of(fields);
    const auto first_missing = [&nodes](const std::vector<std::string>& paths, bool is_text) {
      std::size_t i = 0;
      while (i < paths.size() && assign(nodes, paths[i], static_cast<int>(i), is_text)) ++i;
      return i < paths.size() ? fmt::format("has no {} {}", is_text ? "text" : "number", paths[i]) : "";
    };
    std::string lacks = first_missing(wanted.numbers, false);
    if (lacks.empty()) lacks = first_missing(wanted.texts, true);
    if (lacks.empty()) return nodes;
    if (missing.empty()) missing = std::move(lacks);
  }
  return Error{missing};
}

std::vector<MessageDecoder::Node> MessageDecoder::nodes_of(const std::vector<Field>& fields) {
  std::vector<Node> nodes;
  for (const Field& field : fields) {
    Field own = field;
    own.fields.clear();
    nodes.push_back({std::move(own), nodes_of(field.fields), -1});
  }
  return nodes;
}

bool MessageDecoder::assign(std::vector<Node>& nodes, std::string_view path, int column, bool is_text) {
  if (path.empty()) return true;
  const std::string_view name = path.substr(0, path.find('.'));
  const auto node =
      std::ranges::find_if(nodes, [name](const Node& n) { return same_letters(n.field.name, name); });
  if (node == nodes.end()) return false;
  if (name.size() < path.size()) return assign(node->nodes, path.substr(name.size() + 1), column, is_text);
  const bool holds_text = node->field.primitive == Primitive::kString || is_byte_array(node->field);
  if (node->field.is_message || holds_text != is_text) return false;
  node->column = column;
  return true;
}

Result<void> MessageDecoder::decode(std::string_view bytes) {
  Result<void> done;
  for (auto candidate = candidates_.begin(); candidate != candidates_.end(); ++candidate) {
    for (auto& column : numbers_) column.clear();
    for (auto& column : texts_) column.clear();
    auto read = Walk(*this, candidate->nodes, bytes).run();
    if (read) {
      candidates_.erase(candidates_.begin(), candidate);
      return read;
    }
    if (candidate == candidates_.begin()) done = std::move(read);
  }
  return done;
}

}  // namespace waymark::bag
