#include "workbench/bags/message_definition.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <map>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "workbench/logs/text_lines.hpp"

namespace waymark::bag {
namespace {

/// More than this is no message but an attack.
constexpr int kMaxFields = 20000;
constexpr std::size_t kDeepest = 32;

struct PrimitiveName {
  std::string_view name;
  Primitive primitive;
};

constexpr std::array kPrimitives{
    PrimitiveName{"bool", Primitive::kBool},       PrimitiveName{"int8", Primitive::kInt8},
    PrimitiveName{"uint8", Primitive::kUint8},     PrimitiveName{"int16", Primitive::kInt16},
    PrimitiveName{"uint16", Primitive::kUint16},   PrimitiveName{"int32", Primitive::kInt32},
    PrimitiveName{"uint32", Primitive::kUint32},   PrimitiveName{"int64", Primitive::kInt64},
    PrimitiveName{"uint64", Primitive::kUint64},   PrimitiveName{"float32", Primitive::kFloat32},
    PrimitiveName{"float64", Primitive::kFloat64}, PrimitiveName{"string", Primitive::kString},
    PrimitiveName{"byte", Primitive::kUint8},      PrimitiveName{"char", Primitive::kUint8}};

std::optional<Primitive> primitive_of(std::string_view name) {
  const auto found = std::ranges::find(kPrimitives, name, &PrimitiveName::name);
  return found == kPrimitives.end() ? std::nullopt : std::optional(found->primitive);
}

std::string_view package_of(std::string_view type) { return type.substr(0, type.find('/')); }

/// Takes the next line off the front of `text`, without its comment.
std::string_view take_line(std::string_view& text) {
  const std::size_t end = std::min(text.find('\n'), text.size());
  std::string_view line = text.substr(0, end);
  text.remove_prefix(std::min(end + 1, text.size()));
  return line.substr(0, line.find('#'));
}

/// The texts of a stored definition by type; that of the topic itself comes first and is not named.
std::map<std::string, std::string, std::less<>> split(std::string_view text, std::string_view root) {
  constexpr std::string_view kRule = "========";
  constexpr std::string_view kName = "MSG:";
  std::map<std::string, std::string, std::less<>> texts;
  std::string type(root);
  bool after_rule = false;
  while (!text.empty()) {
    const std::string_view line = take_line(text);
    if (after_rule && line.starts_with(kName)) {
      std::string_view name = line.substr(kName.size());
      type = plain_type(take_word(name));
      texts[type].clear();
    } else if (!line.starts_with(kRule)) {
      texts[type].append(line).push_back('\n');
    }
    after_rule = line.starts_with(kRule);
  }
  return texts;
}

/// "float64[9]", "string<=10[<=5]", "Marker[]" taken apart.
struct TypeWord {
  std::string_view type;
  Shape shape = Shape::kOne;
  std::uint32_t length = 1;
};

std::optional<TypeWord> read_type(std::string_view word) {
  TypeWord read{word.substr(0, word.find('['))};
  const std::string_view array = word.substr(read.type.size());
  read.type = read.type.substr(0, read.type.find('<'));
  if (array.empty()) return read;
  if (!array.ends_with(']')) return std::nullopt;
  const std::string_view length = array.substr(1, array.size() - 2);
  read.shape = length.empty() || length.starts_with("<=") ? Shape::kSequence : Shape::kFixed;
  if (read.shape == Shape::kSequence) return read;
  const auto [end, error] = std::from_chars(length.data(), length.data() + length.size(), read.length);
  return error == std::errc{} && end == length.data() + length.size() ? std::optional(read) : std::nullopt;
}

class Parser {
 public:
  explicit Parser(const Topic& topic) : topic_(topic), texts_(split(topic.definition, topic.type)) {}

  Result<std::vector<Field>> fields_of(const std::string& type) {
    const std::string_view text = text_of(type);
    if (!text.data()) return error(fmt::format("does not include that of {}", type));
    if (std::ranges::find(path_, type) != path_.end() || path_.size() > kDeepest)
      return error(fmt::format("contains itself at {}", type));
    path_.push_back(type);
    auto fields = read_lines(text, package_of(type));
    path_.pop_back();
    return fields;
  }

 private:
  [[nodiscard]] Error error(const std::string& what) const {
    return {fmt::format("{}: the definition of {} {}", topic_.name, topic_.type, what)};
  }

  /// Without data where it is not known.
  [[nodiscard]] std::string_view text_of(const std::string& type) const {
    if (const auto found = texts_.find(type); found != texts_.end()) return found->second;
    const auto known = known_definitions(type, topic_.encoding);
    return known.empty() ? std::string_view{} : known.front();
  }

  [[nodiscard]] std::string full_name(std::string_view type, std::string_view package) const {
    if (type == "Header") return "std_msgs/Header";
    if (type == "time" || type == "duration") return "builtin_interfaces/Time";
    return type.find('/') != std::string_view::npos ? plain_type(type) : fmt::format("{}/{}", package, type);
  }

  Result<std::vector<Field>> read_lines(std::string_view text, std::string_view package) {
    std::vector<Field> fields;
    while (!text.empty()) {
      const std::string_view line = take_line(text);
      std::string_view rest = line;
      const std::string_view type = take_word(rest);
      const std::string_view name = take_word(rest);
      // A constant is in no message.
      const bool is_constant = name.find('=') != std::string_view::npos || take_word(rest).starts_with('=');
      if (type.empty() || is_constant) continue;
      auto field = read_field(type, name, package);
      if (!field) return field.error();
      fields.push_back(*std::move(field));
    }
    return fields;
  }

  Result<Field> read_field(std::string_view type, std::string_view name, std::string_view package) {
    const auto word = read_type(type);
    if (!word || name.empty() || ++count_ > kMaxFields)
      return error(fmt::format("cannot be read at {}", in_quotes(fmt::format("{} {}", type, name))));
    Field field{.name = std::string(name), .shape = word->shape, .length = word->length, .fields = {}};
    if (const auto primitive = primitive_of(word->type)) {
      field.primitive = *primitive;
      return field;
    }
    field.is_message = true;
    auto fields = fields_of(full_name(word->type, package));
    if (!fields) return fields.error();
    field.fields = *std::move(fields);
    return field;
  }

  const Topic& topic_;
  std::map<std::string, std::string, std::less<>> texts_;
  std::vector<std::string> path_;
  int count_ = 0;
};

}  // namespace

std::size_t size_of(Primitive primitive) {
  switch (primitive) {
    case Primitive::kBool:
    case Primitive::kInt8:
    case Primitive::kUint8:
      return 1;
    case Primitive::kInt16:
    case Primitive::kUint16:
      return 2;
    case Primitive::kInt32:
    case Primitive::kUint32:
    case Primitive::kFloat32:
      return 4;
    case Primitive::kInt64:
    case Primitive::kUint64:
    case Primitive::kFloat64:
      return 8;
    case Primitive::kString:
      break;
  }
  return 0;
}

Result<std::vector<Field>> parse_definition(const Topic& topic) {
  return Parser(topic).fields_of(topic.type);
}

Result<std::vector<Layout>> layouts_of(const Topic& topic) {
  std::vector<Layout> layouts;
  auto stored = parse_definition(topic);
  if (stored && !topic.definition.empty()) layouts.push_back({*stored, true});
  for (const std::string_view text : known_definitions(topic.type, topic.encoding)) {
    Topic known = topic;
    known.definition = text;
    if (auto fields = parse_definition(known)) layouts.push_back({*std::move(fields), false});
  }
  if (layouts.empty())
    return stored ? Error{fmt::format("{}: the bag has no definition of {}", topic.name, topic.type)}
                  : stored.error();
  return layouts;
}

bool have_same_wire(const std::vector<Field>& a, const std::vector<Field>& b) {
  return std::ranges::equal(a, b, [](const Field& x, const Field& y) {
    return x.shape == y.shape && x.length == y.length && x.is_message == y.is_message &&
           (x.is_message ? have_same_wire(x.fields, y.fields) : x.primitive == y.primitive);
  });
}

}  // namespace waymark::bag
