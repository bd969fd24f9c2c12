#include "workbench/bags/ros1_format.hpp"

#include <map>
#include <utility>

#include <fmt/format.h>

#include "workbench/bags/byte_reader.hpp"
#include "workbench/bags/chunked_bag.hpp"

namespace waymark::bag {
namespace {

constexpr std::string_view kAnyRosBag = "#ROSBAG V";
constexpr std::string_view kRos1Magic = "#ROSBAG V2.0\n";

/// What a record is, by its field `op`.
enum class Ros1Op : std::uint8_t {
  kMessage = 0x02,
  kBag = 0x03,
  kIndex = 0x04,
  kChunk = 0x05,
  kChunkInfo = 0x06,
  kConnection = 0x07
};

/// The `name=value` fields at the head of a record, and in the data of a connection.
class Fields {
 public:
  explicit Fields(std::string_view bytes) : bytes_(bytes) {}

  /// Empty where there is no such field.
  [[nodiscard]] std::string_view text(std::string_view name) const {
    ByteReader reader(bytes_);
    while (!reader.at_end()) {
      const std::string_view field = reader.counted();
      if (field.size() > name.size() && field.starts_with(name) && field[name.size()] == '=')
        return field.substr(name.size() + 1);
    }
    return {};
  }
  template <class T>
  [[nodiscard]] std::optional<T> number(std::string_view name) const {
    const std::string_view raw = text(name);
    return raw.size() == sizeof(T) ? std::optional(load<T>(raw.data())) : std::nullopt;
  }
  [[nodiscard]] std::optional<Stamp> stamp(std::string_view name) const {
    const std::string_view raw = text(name);
    if (raw.size() != 8) return std::nullopt;
    return Stamp{std::chrono::seconds(load<std::uint32_t>(raw.data())) +
                 Duration(load<std::uint32_t>(raw.data() + 4))};
  }
  [[nodiscard]] Ros1Op op() const { return static_cast<Ros1Op>(number<std::uint8_t>("op").value_or(0)); }

 private:
  std::string_view bytes_;
};

Error no_record(std::string_view why) { return {fmt::format("not a record: {}", why)}; }

/// The length of what comes next, and that many bytes.
Result<std::string_view> take_counted(BufferedStream& stream) {
  if (const auto raw = stream.take(4))
    if (const auto bytes = stream.take(load<std::uint32_t>(raw->data()))) return *bytes;
  return Error{stream.problem()};
}

Result<Record> read_connection(std::uint32_t id, std::string_view topic, BufferedStream& stream) {
  TopicRecord record{id,
                     {.name = std::string(topic), .type = {}, .encoding = Encoding::kRos1, .definition = {}}};
  const auto data = take_counted(stream);
  if (!data) return data.error();
  const Fields fields(*data);
  record.topic.type = fields.text("type");
  record.topic.definition = fields.text("message_definition");
  return Record(std::move(record));
}

Result<Record> read_message(const Fields& fields, BufferedStream& stream) {
  const auto id = fields.number<std::uint32_t>("conn");
  const auto stamp = fields.stamp("time");
  if (!id || !stamp) return no_record("a message without conn or time");
  const auto data = take_counted(stream);
  if (!data) return data.error();
  return Record(MessageRecord{*id, *stamp, *data});
}

class Ros1Format final : public RecordFormat {
 public:
  [[nodiscard]] std::string name() const override { return "ROS 1 bag"; }
  [[nodiscard]] std::uint64_t first_record() const override { return kRos1Magic.size(); }

  [[nodiscard]] Result<Record> read(BufferedStream& stream) override {
    const auto head = take_counted(stream);
    if (!head) return head.error();
    const Fields fields(*head);
    switch (fields.op()) {
      case Ros1Op::kMessage:
        return read_message(fields, stream);
      case Ros1Op::kConnection: {
        const auto id = fields.number<std::uint32_t>("conn");
        if (!id) return no_record("a connection without number");
        return read_connection(*id, std::string(fields.text("topic")), stream);
      }
      case Ros1Op::kChunk: {
        ChunkRecord chunk{std::string(fields.text("compression")), 0,
                          fields.number<std::uint32_t>("size").value_or(0), std::nullopt};
        const auto size = stream.take(4);
        if (!size) return Error{stream.problem()};
        chunk.packed_size = load<std::uint32_t>(size->data());
        return Record(std::move(chunk));
      }
      case Ros1Op::kBag:
      case Ros1Op::kIndex:
      case Ros1Op::kChunkInfo: {
        const auto size = stream.take(4);
        if (!size || !stream.skip(load<std::uint32_t>(size->data()))) return Error{stream.problem()};
        return Record(OtherRecord{});
      }
    }
    return no_record("its kind (op) is missing");
  }
};

/// The record at the front of the file, which says where the index is; 0 where there is none.
struct BagHead {
  std::uint64_t index_position = 0;
  std::uint32_t connections = 0;
  std::uint32_t chunks = 0;
  std::string encryptor;
};

std::optional<BagHead> read_head(const std::shared_ptr<const InputFile>& file) {
  BufferedStream stream(4096);
  stream.reset(std::make_unique<FileSection>(file, kRos1Magic.size(), file->size()));
  const auto head = take_counted(stream);
  if (!head) return std::nullopt;
  const Fields fields(*head);
  if (fields.op() != Ros1Op::kBag) return std::nullopt;
  return BagHead{fields.number<std::uint64_t>("index_pos").value_or(0),
                 fields.number<std::uint32_t>("conn_count").value_or(0),
                 fields.number<std::uint32_t>("chunk_count").value_or(0),
                 std::string(fields.text("encryptor"))};
}

/// Adds one chunk info; false: it makes no sense.
bool add_chunk_info(const Fields& fields, std::string_view data,
                    std::map<std::uint32_t, std::int64_t>& counts, Index& index) {
  const auto position = fields.number<std::uint64_t>("chunk_pos");
  const auto first = fields.stamp("start_time");
  const auto last = fields.stamp("end_time");
  if (!position || !first || !last) return false;
  Index::Chunk chunk{*position, {}};
  ByteReader reader(data);
  while (reader.ok() && !reader.at_end()) {
    const auto id = reader.number<std::uint32_t>();
    counts[id] += reader.number<std::uint32_t>();
    chunk.ids.push_back(id);
  }
  if (!chunk.ids.empty()) {
    index.first = std::min(index.first.value_or(*first), *first);
    index.last = std::max(index.last.value_or(*last), *last);
  }
  index.chunks.push_back(std::move(chunk));
  return reader.ok();
}

/// The index at the end of the file; nothing where it is missing or damaged.
std::optional<Index> read_index(const std::shared_ptr<const InputFile>& file, const BagHead& head) {
  if (head.index_position == 0 || head.index_position > file->size()) return std::nullopt;
  BufferedStream stream(65536);
  stream.reset(std::make_unique<FileSection>(file, head.index_position, file->size()));
  Index index;
  std::map<std::uint32_t, std::int64_t> counts;
  while (!stream.at_end()) {
    const auto raw = take_counted(stream);
    if (!raw) return std::nullopt;
    const std::string fields_bytes(*raw);
    const Fields fields(fields_bytes);
    if (const auto id = fields.number<std::uint32_t>("conn"); id && fields.op() == Ros1Op::kConnection) {
      auto record = read_connection(*id, fields.text("topic"), stream);
      if (!record) return std::nullopt;
      index.topics.push_back(std::get<TopicRecord>(*std::move(record)));
    } else if (fields.op() == Ros1Op::kChunkInfo) {
      const auto data = take_counted(stream);
      if (!data || !add_chunk_info(fields, *data, counts, index)) return std::nullopt;
    } else {
      return std::nullopt;
    }
  }
  for (const auto& [id, messages] : counts) index.counts.push_back({id, messages});
  const bool complete = index.topics.size() == head.connections && index.chunks.size() == head.chunks;
  return complete ? std::optional(std::move(index)) : std::nullopt;
}

}  // namespace

bool is_ros1_bag(std::string_view first_bytes) { return first_bytes.starts_with(kAnyRosBag); }

Result<std::unique_ptr<Reader>> open_ros1_bag(const std::filesystem::path& path) {
  auto file = InputFile::open(path);
  if (!file) return file.error();
  const auto magic = (*file)->front(kRos1Magic.size());
  if (!magic) return Error{path.string() + ": " + magic.error().message};
  if (*magic != kRos1Magic)
    return Error{fmt::format("{}: a ROS bag of version {}; only 2.0 is supported (`rosbag migrate` converts)",
                             path.string(), magic->substr(kAnyRosBag.size(), 3))};
  const auto head = read_head(*file);
  if (!head)
    return Error{fmt::format("{}: an empty or damaged ROS bag: its first record is missing", path.string())};
  if (!head->encryptor.empty())
    return Error{
        fmt::format("{}: the bag is encrypted ({}); decrypt it with rosbag", path.string(), head->encryptor)};
  auto index = read_index(*file, *head);
  return std::unique_ptr<Reader>(std::make_unique<ChunkedBag>(
      path.filename().string(), *std::move(file), std::make_unique<Ros1Format>(), std::move(index)));
}

}  // namespace waymark::bag
