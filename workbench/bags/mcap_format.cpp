#include "workbench/bags/mcap_format.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "workbench/bags/byte_reader.hpp"
#include "workbench/bags/chunked_bag.hpp"

namespace waymark::bag {
namespace {

constexpr std::string_view kAnyMcap = "\x89MCAP";
constexpr std::string_view kMcapMagic = "\x89MCAP0\r\n";

enum class McapOp : std::uint8_t {
  kFooter = 0x02,
  kSchema = 0x03,
  kChannel = 0x04,
  kMessage = 0x05,
  kChunk = 0x06,
  kChunkIndex = 0x08,
  kStatistics = 0x0B,
  kDataEnd = 0x0F
};

/// The kind of a record and the length of its content.
constexpr std::size_t kHeadSize = 1 + 8;
/// A chunk's times, size and CRC, and the length of the name of its compression.
constexpr std::size_t kChunkHeadSize = 8 + 8 + 8 + 4 + 4;
constexpr std::size_t kMessageHeadSize = 2 + 4 + 8 + 8;
constexpr std::size_t kFooterSize = kHeadSize + 8 + 8 + 4;

struct Head {
  McapOp op{};
  std::uint64_t size = 0;
};

std::optional<Head> take_head(BufferedStream& stream) {
  const auto raw = stream.take(kHeadSize);
  if (!raw) return std::nullopt;
  return Head{static_cast<McapOp>(raw->front()), load<std::uint64_t>(raw->data() + 1)};
}

/// Nanoseconds; what a Stamp cannot hold, or nearly not, is nonsense and becomes 0.
Stamp stamp_of(std::uint64_t nanos) {
  constexpr std::uint64_t kLatest = 4'300'000'000'000'000'000;
  return Stamp{Duration(nanos <= kLatest ? static_cast<std::int64_t>(nanos) : 0)};
}

Encoding encoding_of(std::string_view name) {
  return name == "cdr" ? Encoding::kCdr : name == "ros1" ? Encoding::kRos1 : Encoding::kOther;
}

/// Schemas and channels, which stand in the data and again in the summary.
class Channels {
 public:
  bool add_schema(std::string_view content) {
    ByteReader reader(content);
    const auto id = reader.number<std::uint16_t>();
    Schema schema;
    schema.type = plain_type(reader.counted());
    const std::string_view encoding = reader.counted();
    const std::string_view text = reader.counted();
    // Of a type in another language the name is left; it may be one that every ROS knows.
    if (encoding == "ros1msg" || encoding == "ros2msg") schema.definition = text;
    if (reader.ok()) schemas_[id] = std::move(schema);
    return reader.ok();
  }

  [[nodiscard]] std::optional<TopicRecord> read_channel(std::string_view content) const {
    ByteReader reader(content);
    TopicRecord record;
    record.id = reader.number<std::uint16_t>();
    const auto schema = schemas_.find(reader.number<std::uint16_t>());
    record.topic.name = reader.counted();
    record.topic.encoding = encoding_of(reader.counted());
    if (schema != schemas_.end()) {
      record.topic.type = schema->second.type;
      record.topic.definition = schema->second.definition;
    }
    return reader.ok() ? std::optional(std::move(record)) : std::nullopt;
  }

 private:
  struct Schema {
    std::string type;
    std::string definition;
  };
  std::map<std::uint16_t, Schema> schemas_;
};

class McapFormat final : public RecordFormat {
 public:
  [[nodiscard]] std::string name() const override { return "MCAP"; }
  [[nodiscard]] std::uint64_t first_record() const override { return kMcapMagic.size(); }

  [[nodiscard]] Result<Record> read(BufferedStream& stream) override {
    const auto head = take_head(stream);
    if (!head) return Error{stream.problem()};
    auto record = read_content(*head, stream);
    if (!record && record.error().message.empty()) return Error{"its record is damaged"};
    return record;
  }

 private:
  /// An error without message where a record was complete and made no sense.
  Result<Record> read_content(const Head& head, BufferedStream& stream) {
    if (head.op == McapOp::kDataEnd || head.op == McapOp::kFooter) return Record(EndRecord{});
    if (head.op == McapOp::kChunk) return read_chunk(head.size, stream);
    if (head.op != McapOp::kMessage && head.op != McapOp::kSchema && head.op != McapOp::kChannel) {
      if (!stream.skip(head.size)) return Error{stream.problem()};
      return Record(OtherRecord{});
    }
    const auto content = stream.take(head.size);
    if (!content) return Error{stream.problem()};
    if (head.op == McapOp::kMessage) return read_message(*content);
    if (head.op == McapOp::kChannel) {
      auto channel = channels_.read_channel(*content);
      return channel ? Result<Record>(*std::move(channel)) : Error{};
    }
    return channels_.add_schema(*content) ? Result<Record>(OtherRecord{}) : Error{};
  }

  static Result<Record> read_message(std::string_view content) {
    if (content.size() < kMessageHeadSize) return Error{};
    return Record(MessageRecord{load<std::uint16_t>(content.data()),
                                stamp_of(load<std::uint64_t>(content.data() + 6)),
                                content.substr(kMessageHeadSize)});
  }

  static Result<Record> read_chunk(std::uint64_t size, BufferedStream& stream) {
    const auto head = stream.take(kChunkHeadSize);
    if (!head) return Error{stream.problem()};
    ByteReader reader(*head);
    reader.take(16);  // its times
    ChunkRecord chunk;
    chunk.size = reader.number<std::uint64_t>();
    if (const auto crc32 = reader.number<std::uint32_t>(); crc32 != 0) chunk.crc32 = crc32;
    const auto compression = stream.take(reader.number<std::uint32_t>());
    if (!compression) return Error{stream.problem()};
    chunk.compression = *compression;
    const auto packed_size = stream.take(8);
    if (!packed_size) return Error{stream.problem()};
    chunk.packed_size = load<std::uint64_t>(packed_size->data());
    const std::uint64_t before = kChunkHeadSize + chunk.compression.size() + 8;
    if (before > size || chunk.packed_size > size - before) return Error{};
    return Record(std::move(chunk));
  }

  Channels channels_;
};

/// How many messages there are in each channel, and when.
bool take_statistics(std::string_view content, Index& index) {
  ByteReader reader(content);
  const auto messages = reader.number<std::uint64_t>();
  reader.take(2 + 4 + 4 + 4 + 4);  // further counts
  const Stamp first = stamp_of(reader.number<std::uint64_t>());
  const Stamp last = stamp_of(reader.number<std::uint64_t>());
  if (messages > 0) {
    index.first = std::min(first, last);
    index.last = std::max(first, last);
  }
  ByteReader counts(reader.counted());
  while (counts.ok() && !counts.at_end()) {
    const auto id = counts.number<std::uint16_t>();
    const auto count = counts.number<std::uint64_t>();
    index.counts.push_back({id, static_cast<std::int64_t>(std::min<std::uint64_t>(count, messages))});
  }
  return reader.ok() && counts.ok();
}

bool take_chunk_index(std::string_view content, Index& index) {
  ByteReader reader(content);
  reader.take(8 + 8);  // its times
  Index::Chunk chunk{reader.number<std::uint64_t>(), {}};
  reader.take(8);  // its length
  ByteReader places(reader.counted());
  while (places.ok() && !places.at_end()) {
    chunk.ids.push_back(places.number<std::uint16_t>());
    places.take(8);
  }
  index.chunks.push_back(std::move(chunk));
  return reader.ok() && places.ok();
}

/// Where the summary begins; 0 without one.
std::uint64_t summary_position(const InputFile& file) {
  std::string tail(kFooterSize + kMcapMagic.size(), '\0');
  if (file.size() < tail.size()) return 0;
  const auto count = file.read(file.size() - tail.size(), tail);
  if (!count || *count != tail.size() || !tail.ends_with(kMcapMagic) ||
      static_cast<McapOp>(tail[0]) != McapOp::kFooter)
    return 0;
  return load<std::uint64_t>(tail.data() + kHeadSize);
}

/// The summary of a file whose messages are in chunks that know what they hold; nothing where it is missing,
/// damaged, or tells less than that.
std::optional<Index> read_index(const std::shared_ptr<const InputFile>& file) {
  const std::uint64_t position = summary_position(*file);
  if (position == 0 || position >= file->size()) return std::nullopt;
  BufferedStream stream(65536);
  stream.reset(std::make_unique<FileSection>(file, position, file->size()));
  Index index;
  Channels channels;
  bool has_statistics = false;
  while (const auto head = take_head(stream)) {
    const auto content = stream.take(head->size);
    if (!content) return std::nullopt;
    bool ok = true;
    if (head->op == McapOp::kFooter) break;
    if (head->op == McapOp::kSchema) ok = channels.add_schema(*content);
    if (head->op == McapOp::kChunkIndex) ok = take_chunk_index(*content, index);
    if (head->op == McapOp::kStatistics) ok = has_statistics = take_statistics(*content, index);
    if (head->op == McapOp::kChannel) {
      auto channel = channels.read_channel(*content);
      ok = channel.has_value();
      if (ok) index.topics.push_back(*std::move(channel));
    }
    if (!ok) return std::nullopt;
  }
  const bool tells_all =
      has_statistics && (!index.first || !index.chunks.empty()) &&
      std::ranges::none_of(index.chunks, [](const Index::Chunk& chunk) { return chunk.ids.empty(); }) &&
      std::ranges::all_of(index.counts, [&index](const Index::Count& count) {
        return std::ranges::find(index.topics, count.id, &TopicRecord::id) != index.topics.end();
      });
  return tells_all ? std::optional(std::move(index)) : std::nullopt;
}

}  // namespace

bool is_mcap(std::string_view first_bytes) { return first_bytes.starts_with(kAnyMcap); }

Result<std::unique_ptr<Reader>> open_mcap(const std::filesystem::path& path) {
  auto file = InputFile::open(path);
  if (!file) return file.error();
  const auto magic = (*file)->front(kMcapMagic.size());
  if (!magic) return Error{path.string() + ": " + magic.error().message};
  if (*magic != kMcapMagic)
    return Error{fmt::format("{}: an MCAP file of version {}; only version 0 is supported", path.string(),
                             magic->substr(kAnyMcap.size(), 1))};
  auto index = read_index(*file);
  return std::unique_ptr<Reader>(std::make_unique<ChunkedBag>(
      path.filename().string(), *std::move(file), std::make_unique<McapFormat>(), std::move(index)));
}

}  // namespace waymark::bag
