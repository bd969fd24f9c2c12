#include "workbench/live/mcap_writer.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

#include <fmt/format.h>
#include <zlib.h>
#include <zstd.h>

namespace waymark::live {
namespace {

static_assert(std::endian::native == std::endian::little);

constexpr std::string_view kMagic("\x89MCAP0\r\n", 8);
constexpr std::size_t kChunkSize = 1 << 20;

enum class Op : std::uint8_t {
  kHeader = 0x01,
  kFooter = 0x02,
  kSchema = 0x03,
  kChannel = 0x04,
  kMessage = 0x05,
  kChunk = 0x06,
  kMessageIndex = 0x07,
  kChunkIndex = 0x08,
  kStatistics = 0x0b,
  kDataEnd = 0x0f
};

/// Puts together the content of a record.
class Bytes {
 public:
  template <class Number>
  Bytes& number(Number value) {
    std::array<char, sizeof(Number)> raw{};
    std::memcpy(raw.data(), &value, raw.size());
    text_.append(raw.data(), raw.size());
    return *this;
  }
  Bytes& raw(std::string_view bytes) {
    text_ += bytes;
    return *this;
  }
  Bytes& text(std::string_view bytes) { return number(static_cast<std::uint32_t>(bytes.size())).raw(bytes); }
  [[nodiscard]] const std::string& get() const { return text_; }

 private:
  std::string text_;
};

std::string record(Op op, std::string_view content) {
  return Bytes()
      .number(static_cast<std::uint8_t>(op))
      .number(static_cast<std::uint64_t>(content.size()))
      .raw(content)
      .get();
}

std::uint64_t nanoseconds(Stamp stamp) {
  return static_cast<std::uint64_t>(std::max<std::int64_t>(stamp.since_epoch.count(), 0));
}

std::uint32_t checksum(std::string_view bytes) {
  return static_cast<std::uint32_t>(
      crc32(0, reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uInt>(bytes.size())));
}

std::string pack(std::string_view bytes) {
  std::string packed(ZSTD_compressBound(bytes.size()), '\0');
  packed.resize(ZSTD_compress(packed.data(), packed.size(), bytes.data(), bytes.size(), 1));
  return packed;
}

}  // namespace

Result<McapWriter> McapWriter::open(const std::string& path) {
  std::ofstream file(path, std::ios::binary | std::ios::trunc);
  if (!file) return Error{fmt::format("{}: cannot be written", path)};
  McapWriter writer(path, std::move(file));
  writer.put(kMagic);
  writer.put(record(Op::kHeader, Bytes().text("ros2").text("waymark").get()));
  return writer;
}

void McapWriter::put(std::string_view bytes) {
  file_.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  position_ += bytes.size();
}

std::uint16_t McapWriter::add(const Channel& channel) {
  channels_.push_back(channel);
  return static_cast<std::uint16_t>(channels_.size());
}

/// Schemas and channels, numbered alike from 1; a channel without schema has the schema 0.
std::string McapWriter::declarations() const {
  std::string all;
  std::uint16_t id = 0;
  for (const Channel& channel : channels_) {
    ++id;
    if (!channel.schema_name.empty())
      all += record(Op::kSchema, Bytes()
                                     .number(id)
                                     .text(channel.schema_name)
                                     .text(channel.schema_encoding)
                                     .text(channel.schema)
                                     .get());
    all += record(Op::kChannel, Bytes()
                                    .number(id)
                                    .number(channel.schema_name.empty() ? std::uint16_t{0} : id)
                                    .text(channel.topic)
                                    .text(channel.encoding)
                                    .text("")
                                    .get());
  }
  return all;
}

/// The first chunk begins with all schemas and channels; those after it know them.
void McapWriter::write(std::uint16_t channel, Stamp logged, Stamp published, std::string_view bytes) {
  if (counts_.empty()) chunk_ = declarations();
  const std::uint64_t time = nanoseconds(logged);
  open_.first = index_.empty() ? time : std::min(open_.first, time);
  open_.last = index_.empty() ? time : std::max(open_.last, time);
  index_[channel].push_back({time, chunk_.size()});
  ++counts_[channel];
  chunk_ += record(Op::kMessage, Bytes()
                                     .number(channel)
                                     .number(sequence_++)
                                     .number(time)
                                     .number(nanoseconds(published))
                                     .raw(bytes)
                                     .get());
  if (chunk_.size() >= kChunkSize) end_chunk();
}

void McapWriter::end_chunk() {
  if (index_.empty()) return;
  const std::string packed = pack(chunk_);
  ChunkRecord& chunk = chunks_.emplace_back(open_);
  chunk.start = position_;
  chunk.size = chunk_.size();
  chunk.packed_size = packed.size();
  put(record(Op::kChunk, Bytes()
                             .number(chunk.first)
                             .number(chunk.last)
                             .number(chunk.size)
                             .number(checksum(chunk_))
                             .text("zstd")
                             .number(static_cast<std::uint64_t>(packed.size()))
                             .raw(packed)
                             .get()));
  chunk.length = position_ - chunk.start;
  for (const auto& [channel, entries] : index_) {
    chunk.index_offsets[channel] = position_;
    Bytes list;
    for (const auto& [time, offset] : entries) list.number(time).number(offset);
    put(record(Op::kMessageIndex, Bytes().number(channel).text(list.get()).get()));
  }
  chunk.index_length = position_ - chunk.start - chunk.length;
  chunk_.clear();
  index_.clear();
  open_ = {};
}

Result<void> McapWriter::flush() {
  end_chunk();
  file_.flush();
  return check();
}

Result<void> McapWriter::check() const {
  if (file_) return {};
  return Error{fmt::format("{}: writing failed; is the disk full?", path_), Error::Kind::kFailed};
}

Result<void> McapWriter::close() {
  end_chunk();
  put(record(Op::kDataEnd, Bytes().number(std::uint32_t{0}).get()));
  const std::uint64_t start = position_;
  std::string summary = declarations();
  std::uint64_t messages = 0, first = 0, last = 0;
  Bytes counts;
  for (const auto& [channel, count] : counts_) {
    counts.number(channel).number(count);
    messages += count;
  }
  for (const ChunkRecord& chunk : chunks_) {
    first = chunk.start == chunks_.front().start ? chunk.first : std::min(first, chunk.first);
    last = std::max(last, chunk.last);
  }
  summary += record(Op::kStatistics, Bytes()
                                         .number(messages)
                                         .number(static_cast<std::uint16_t>(channels_.size()))
                                         .number(static_cast<std::uint32_t>(channels_.size()))
                                         .number(std::uint32_t{0})
                                         .number(std::uint32_t{0})
                                         .number(static_cast<std::uint32_t>(chunks_.size()))
                                         .number(first)
                                         .number(last)
                                         .text(counts.get())
                                         .get());
  for (const ChunkRecord& chunk : chunks_) {
    Bytes offsets;
    for (const auto& [channel, offset] : chunk.index_offsets) offsets.number(channel).number(offset);
    summary += record(Op::kChunkIndex, Bytes()
                                           .number(chunk.first)
                                           .number(chunk.last)
                                           .number(chunk.start)
                                           .number(chunk.length)
                                           .text(offsets.get())
                                           .number(chunk.index_length)
                                           .text("zstd")
                                           .number(chunk.packed_size)
                                           .number(chunk.size)
                                           .get());
  }
  put(summary);
  const std::string footer = Bytes().number(start).number(std::uint64_t{0}).get();
  const std::string head =
      Bytes().number(static_cast<std::uint8_t>(Op::kFooter)).number(std::uint64_t{20}).get();
  put(record(Op::kFooter, Bytes().raw(footer).number(checksum(summary + head + footer)).get()));
  put(kMagic);
  file_.close();
  return check();
}

}  // namespace waymark::live
