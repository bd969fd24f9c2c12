#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <variant>
#include <vector>

#include "workbench/bags/byte_stream.hpp"
#include "workbench/bags/reader.hpp"

namespace waymark::bag {

/// What the records of ROS 1 bags and of MCAP files say. Ids are those of the file.
struct TopicRecord {
  std::uint32_t id = 0;
  Topic topic;
};
struct MessageRecord {
  std::uint32_t id = 0;
  Stamp recorded;
  std::string_view bytes;
};
/// The head of a chunk; its packed bytes come next in the stream.
struct ChunkRecord {
  std::string compression;
  std::uint64_t packed_size = 0;
  std::uint64_t size = 0;
  std::optional<std::uint32_t> crc32;
};
/// One that says nothing about messages.
struct OtherRecord {};
/// The messages end here, whatever follows.
struct EndRecord {};
using Record = std::variant<TopicRecord, MessageRecord, ChunkRecord, OtherRecord, EndRecord>;

/// How one kind of file writes its records.
class RecordFormat {
 public:
  RecordFormat() = default;
  RecordFormat(const RecordFormat&) = delete;
  RecordFormat& operator=(const RecordFormat&) = delete;
  virtual ~RecordFormat() = default;

  /// What such a file is called.
  [[nodiscard]] virtual std::string name() const = 0;

  /// Where the first record begins.
  [[nodiscard]] virtual std::uint64_t first_record() const = 0;

  /// The next record of a file or of a chunk, which is not at its end. An error: it is damaged or cut off.
  /// The bytes of a message are valid until the next call.
  [[nodiscard]] virtual Result<Record> read(BufferedStream& stream) = 0;
};

/// What the index of a file says.
struct Index {
  struct Chunk {
    std::uint64_t position = 0;      ///< of its record
    std::vector<std::uint32_t> ids;  ///< of the topics in it
  };
  struct Count {
    std::uint32_t id = 0;
    std::int64_t messages = 0;
  };
  std::vector<TopicRecord> topics;
  std::vector<Count> counts;
  std::vector<Chunk> chunks;  ///< all messages are in these
  std::optional<Stamp> first;
  std::optional<Stamp> last;
};

/// A file of records, some of which are chunks of further records. Without an index it is read once from
/// start to end to see what is in it.
class ChunkedBag final : public Reader {
 public:
  ChunkedBag(std::string name, std::shared_ptr<const InputFile> file, std::unique_ptr<RecordFormat> format,
             std::optional<Index> index);

  [[nodiscard]] const Summary& summary() const override { return summary_; }
  void rewind(std::vector<bool> wanted) override;
  [[nodiscard]] std::optional<Message> next() override;
  [[nodiscard]] std::vector<std::string> notes() const override { return notes_; }
  [[nodiscard]] double progress() const override;

 private:
  void take_index();
  void look_through();
  std::size_t add_topic(TopicRecord record);
  [[nodiscard]] bool wants(const Index::Chunk& chunk) const;
  [[nodiscard]] std::optional<Message> next_of_any_topic();
  [[nodiscard]] std::optional<Message> take(Record record);
  /// Goes behind the chunk, or to the next one that is wanted; false: the file is at its end.
  [[nodiscard]] bool go_on();
  void enter(const ChunkRecord& chunk);
  void leave();
  void note_damage(const std::string& what);

  std::string name_;
  std::shared_ptr<const InputFile> file_;
  std::unique_ptr<RecordFormat> format_;
  std::optional<Index> index_;
  Summary summary_;
  std::unordered_map<std::uint32_t, std::size_t> places_;  // of ids among the summary's topics
  std::vector<bool> wanted_;
  std::vector<std::string> notes_;

  BufferedStream outer_;
  BufferedStream inner_;
  bool in_chunk_ = false;
  bool at_end_ = false;
  std::size_t next_chunk_ = 0;         // of the index
  std::uint64_t record_position_ = 0;  // of the outer one that is being read
  std::uint64_t chunk_end_ = 0;
};

}  // namespace waymark::bag
