#pragma once

#include <cstdint>
#include <fstream>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "waymark/core/result.hpp"
#include "waymark/core/stamp.hpp"

namespace waymark::live {

/// Writes an MCAP file (mcap.dev/spec, version 0, profile ros2) while its messages arrive: in chunks packed
/// by zstd, which end with a megabyte or when flush() says so, each with its message index. What is in ended
/// chunks survives if writing breaks off; close() adds the summary, without which most readers refuse or
/// search the file.
class McapWriter {
 public:
  [[nodiscard]] static Result<McapWriter> open(const std::string& path);

  /// A channel of messages; `schema_encoding` is ros2msg, jsonschema or empty.
  struct Channel {
    std::string topic;
    std::string encoding;  ///< of its messages: cdr or json
    std::string schema_name;
    std::string schema_encoding;
    std::string schema;
  };
  /// Its number for write(). Channels are told before the first message.
  [[nodiscard]] std::uint16_t add(const Channel& channel);

  void write(std::uint16_t channel, Stamp logged, Stamp published, std::string_view bytes);

  /// Ends the chunk and hands all of it to the system. An error: the disk does not take it, as from then on.
  [[nodiscard]] Result<void> flush();

  /// Summary and end of the file.
  [[nodiscard]] Result<void> close();

  [[nodiscard]] std::uint64_t bytes_written() const { return position_; }

 private:
  struct IndexEntry {
    std::uint64_t time;
    std::uint64_t offset;
  };
  struct ChunkRecord {
    std::uint64_t first = 0;
    std::uint64_t last = 0;
    std::uint64_t start = 0;
    std::uint64_t length = 0;
    std::map<std::uint16_t, std::uint64_t> index_offsets;
    std::uint64_t index_length = 0;
    std::uint64_t packed_size = 0;
    std::uint64_t size = 0;
  };

  McapWriter(std::string path, std::ofstream file) : path_(std::move(path)), file_(std::move(file)) {}
  void put(std::string_view bytes);
  void end_chunk();
  [[nodiscard]] std::string declarations() const;
  [[nodiscard]] Result<void> check() const;

  std::string path_;
  std::ofstream file_;
  std::uint64_t position_ = 0;
  std::vector<Channel> channels_;
  std::map<std::uint16_t, std::uint64_t> counts_;
  std::uint32_t sequence_ = 0;
  std::string chunk_;
  std::map<std::uint16_t, std::vector<IndexEntry>> index_;
  ChunkRecord open_;
  std::vector<ChunkRecord> chunks_;
};

}  // namespace waymark::live
