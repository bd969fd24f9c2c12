#include "workbench/datasets/mat_structure.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <optional>

#include <fmt/format.h>
#include <zlib.h>

namespace waymark {
namespace {

constexpr std::size_t kHeaderBytes = 128;
constexpr std::size_t kTagBytes = 8;
constexpr std::size_t kUnpackedMax = std::size_t{256} << 20;

// Data types of elements.
constexpr std::uint32_t kInt8 = 1;
constexpr std::uint32_t kInt32 = 5;
constexpr std::uint32_t kUint32 = 6;
constexpr std::uint32_t kMatrix = 14;
constexpr std::uint32_t kCompressed = 15;
// Array class and the flag of an imaginary part.
constexpr std::uint32_t kCellClass = 1;
constexpr std::uint32_t kDoubleClass = 6;
constexpr std::uint32_t kComplexFlag = 0x800;

std::uint32_t word_at(std::string_view bytes, std::size_t position) {
  std::uint32_t word = 0;
  std::memcpy(&word, bytes.data() + position, sizeof(word));
  return word;
}

/// Bytes of one number of a data type; 0: the type is not that of numbers.
std::size_t number_bytes(std::uint32_t type) {
  constexpr std::array<std::size_t, 14> kBytes{0, 1, 1, 2, 2, 4, 4, 4, 0, 8, 0, 0, 8, 8};
  return type < kBytes.size() ? kBytes[type] : 0;
}

struct Element {
  std::uint32_t type = 0;
  std::string_view data;
};

/// Takes the first element off the front of `rest`, with its padding to 8 bytes where the format has it.
/// Nothing: it does not fit.
std::optional<Element> take_element(std::string_view& rest) {
  if (rest.size() < kTagBytes) return std::nullopt;
  const std::uint32_t first = word_at(rest, 0);
  const bool is_small = (first >> 16U) != 0;  // up to four bytes of data within the tag
  const std::size_t size = is_small ? first >> 16U : word_at(rest, 4);
  const std::size_t start = is_small ? 4 : kTagBytes;
  if (size > rest.size() - start || (is_small && size > 4)) return std::nullopt;
  const Element element{is_small ? first & 0xFFFFU : first, rest.substr(start, size)};
  const std::size_t padded = element.type == kCompressed ? size : (size + 7) / 8 * 8;
  rest.remove_prefix(is_small ? kTagBytes : std::min(rest.size(), start + padded));
  return element;
}

/// What a compressed element holds; nothing if its checksum is wrong, it breaks off or is too large.
std::optional<std::string> unpack(std::string_view packed) {
  z_stream stream{};
  if (inflateInit(&stream) != Z_OK) return std::nullopt;
  std::string unpacked;
  std::array<char, 1 << 16> chunk{};
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data()));  // NOLINT: zlib's interface
  stream.avail_in = static_cast<uInt>(packed.size());
  int state = Z_OK;
  while (state == Z_OK && unpacked.size() <= kUnpackedMax) {
    stream.next_out = reinterpret_cast<Bytef*>(chunk.data());  // NOLINT: zlib's interface
    stream.avail_out = static_cast<uInt>(chunk.size());
    state = inflate(&stream, Z_NO_FLUSH);
    unpacked.append(chunk.data(), chunk.size() - stream.avail_out);
  }
  const bool is_whole = state == Z_STREAM_END && stream.avail_in == 0;
  inflateEnd(&stream);
  return is_whole ? std::optional(std::move(unpacked)) : std::nullopt;
}

bool is_name(std::string_view name) {
  constexpr std::size_t kLongest = 63;
  const auto is_allowed = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
  };
  return !name.empty() && name.size() <= kLongest && std::ranges::all_of(name, is_allowed);
}

/// What a matrix element begins with.
struct ArrayHead {
  std::uint32_t flags = 0;
  std::string_view dimensions;
  std::string_view name;

  [[nodiscard]] std::uint32_t array_class() const { return flags & 0xFFU; }
  [[nodiscard]] bool is_plane() const { return dimensions.size() == 8; }
  [[nodiscard]] std::uint64_t count() const {
    return std::uint64_t{word_at(dimensions, 0)} * word_at(dimensions, 4);
  }
};

/// Takes it off the front of `rest`; what is wrong with it, if anything.
std::optional<std::string> take_head(std::string_view& rest, ArrayHead& head) {
  const auto flags = take_element(rest);
  if (!flags || flags->type != kUint32 || flags->data.size() != 8) return "broken array flags";
  const auto dimensions = take_element(rest);
  if (!dimensions || dimensions->type != kInt32 || dimensions->data.size() < 8) return "broken dimensions";
  const auto name = take_element(rest);
  if (!name || name->type != kInt8) return "a broken name";
  head = {word_at(flags->data, 0), dimensions->data, name->data};
  return std::nullopt;
}

/// The numbers of a plain matrix: what is wrong with them, if anything.
std::optional<std::string> fault_of_numbers(const ArrayHead& head, std::string_view rest) {
  if (head.array_class() != kDoubleClass || !head.is_plane() || (head.flags & kComplexFlag) != 0)
    return "which is not a matrix of real numbers";
  const auto numbers = take_element(rest);
  if (!numbers || number_bytes(numbers->type) == 0 ||
      head.count() != numbers->data.size() / number_bytes(numbers->type) ||
      numbers->data.size() % number_bytes(numbers->type) != 0)
    return "whose number of values is not the one stated";
  if (!rest.empty()) return "with extra data after its values";
  return std::nullopt;
}

/// The cells of a cell array: nameless plain matrices.
std::optional<std::string> fault_of_cells(const ArrayHead& array, std::string_view rest) {
  std::uint64_t count = 0;
  for (; !rest.empty(); ++count) {
    auto cell = take_element(rest);
    if (!cell || cell->type != kMatrix) return "with a cell that is not a matrix";
    ArrayHead head;
    if (auto fault = take_head(cell->data, head)) return "with a cell that has " + *fault;
    if (!head.name.empty()) return "with a cell that has a name";
    if (auto fault = fault_of_numbers(head, cell->data)) return "with a cell " + *fault;
  }
  if (!array.is_plane() || count != array.count()) return "whose number of cells is not the one stated";
  return std::nullopt;
}

/// The content of a matrix element; what is wrong with it, if anything.
std::optional<std::string> fault_of_matrix(std::string_view rest) {
  ArrayHead head;
  if (auto fault = take_head(rest, head)) return fault;
  if (!is_name(head.name)) return "a broken name";
  const auto fault =
      head.array_class() == kCellClass ? fault_of_cells(head, rest) : fault_of_numbers(head, rest);
  if (fault)
    return fmt::format("variable {}{} {}", head.name, fault->starts_with("which") ? "," : "", *fault);
  return std::nullopt;
}

std::optional<std::string> fault_of_packed(std::string_view packed) {
  const auto unpacked = unpack(packed);
  if (!unpacked) return "compressed data that is damaged or larger than 256 MB";
  std::string_view rest = *unpacked;
  const auto element = take_element(rest);
  if (!element || element->type != kMatrix || !rest.empty()) return "compressed data that is not a variable";
  return fault_of_matrix(element->data);
}

std::optional<std::string> fault_of_header(std::string_view bytes) {
  constexpr std::string_view kMagic = "MATLAB 5.0 MAT-file";
  constexpr std::string_view kVersionAndOrder{"\x00\x01IM", 4};
  if (bytes.starts_with("MATLAB 7.3")) return "level 7.3; save it as level 5 (-v7)";
  if (bytes.size() < kHeaderBytes || !bytes.starts_with(kMagic)) return "no header of a level 5 file";
  if (bytes.substr(kHeaderBytes - 4, 4) != kVersionAndOrder) return "unsupported version or byte order";
  return std::nullopt;
}

}  // namespace

Result<void> check_mat_structure(std::string_view bytes, const std::string& name) {
  if (const auto fault = fault_of_header(bytes))
    return Error{fmt::format("{}: is not a MATLAB file that can be read: {}", name, *fault)};
  std::string_view rest = bytes.substr(kHeaderBytes);
  while (!rest.empty()) {
    const std::size_t position = bytes.size() - rest.size();
    const auto element = take_element(rest);
    std::optional<std::string> fault = "an element that ends after the end of the file";
    if (element && element->type == kMatrix)
      fault = fault_of_matrix(element->data);
    else if (element && element->type == kCompressed)
      fault = fault_of_packed(element->data);
    else if (element)
      fault = "an element of an unknown type";
    if (fault) return Error{fmt::format("{}: damaged MATLAB file: at byte {}, {}", name, position, *fault)};
  }
  return {};
}

}  // namespace waymark
