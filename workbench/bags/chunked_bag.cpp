#include "workbench/bags/chunked_bag.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "workbench/bags/decompress.hpp"

namespace waymark::bag {
namespace {

// A file is read in small steps from head to head, a chunk in large ones.
constexpr std::size_t kOuterBlock = 16384;
constexpr std::size_t kInnerBlock = 1 << 20;

}  // namespace

ChunkedBag::ChunkedBag(std::string name, std::shared_ptr<const InputFile> file,
                       std::unique_ptr<RecordFormat> format, std::optional<Index> index)
    : name_(std::move(name)),
      file_(std::move(file)),
      format_(std::move(format)),
      index_(std::move(index)),
      outer_(kOuterBlock),
      inner_(kInnerBlock) {
  summary_.format = format_->name();
  if (index_) {
    take_index();
  } else {
    look_through();
  }
  rewind(std::vector<bool>(summary_.topics.size(), true));
}

void ChunkedBag::take_index() {
  for (auto& topic : index_->topics) add_topic(std::move(topic));
  for (const auto& [id, messages] : index_->counts)
    if (const auto place = places_.find(id); place != places_.end())
      summary_.topics[place->second].messages += messages;
  std::ranges::sort(index_->chunks, {}, &Index::Chunk::position);
  summary_.first = index_->first;
  summary_.last = index_->last;
}

void ChunkedBag::look_through() {
  add_note(
      notes_,
      name_ + ": has no index, because recording was cut off; the whole file was read to find its content");
  rewind({});
  while (const auto message = next_of_any_topic()) {
    ++summary_.topics[message->topic].messages;
    include(summary_, message->recorded);
  }
}

void ChunkedBag::rewind(std::vector<bool> wanted) {
  wanted_ = std::move(wanted);
  in_chunk_ = false;
  at_end_ = false;
  next_chunk_ = 0;
  if (index_) {
    at_end_ = !go_on();
  } else {
    chunk_end_ = format_->first_record();
    leave();
  }
}

std::optional<Message> ChunkedBag::next() {
  while (auto message = next_of_any_topic())
    if (message->topic < wanted_.size() && wanted_[message->topic]) return message;
  return std::nullopt;
}

std::optional<Message> ChunkedBag::next_of_any_topic() {
  while (!at_end_) {
    BufferedStream& stream = in_chunk_ ? inner_ : outer_;
    if (!in_chunk_) record_position_ = stream.position();
    auto record = stream.at_end() ? Result<Record>(EndRecord{}) : format_->read(stream);
    if (!stream.problem().empty() || !record) {
      note_damage(record ? stream.problem() : record.error().message);
      at_end_ = !go_on();
    } else if (auto message = take(*std::move(record))) {
      return message;
    }
  }
  return std::nullopt;
}

std::optional<Message> ChunkedBag::take(Record record) {
  if (const auto* message = std::get_if<MessageRecord>(&record)) {
    if (const auto place = places_.find(message->id); place != places_.end())
      return Message{place->second, message->recorded, message->bytes};
    add_note(notes_, fmt::format("{}: messages of topic number {} skipped, which the bag does not describe",
                                 name_, message->id));
  } else if (auto* topic = std::get_if<TopicRecord>(&record)) {
    add_topic(std::move(*topic));
  } else if (const auto* chunk = std::get_if<ChunkRecord>(&record); chunk != nullptr && !in_chunk_) {
    enter(*chunk);
  } else if (std::holds_alternative<EndRecord>(record)) {
    at_end_ = !go_on();
  }
  return std::nullopt;
}

std::size_t ChunkedBag::add_topic(TopicRecord record) {
  const std::size_t place = place_topic(summary_.topics, std::move(record.topic));
  places_[record.id] = place;
  return place;
}

bool ChunkedBag::wants(const Index::Chunk& chunk) const {
  return std::ranges::any_of(chunk.ids, [this](std::uint32_t id) {
    const auto place = places_.find(id);
    return place != places_.end() && place->second < wanted_.size() && wanted_[place->second];
  });
}

bool ChunkedBag::go_on() {
  if (!index_) {
    if (!in_chunk_) return false;
    leave();
    return true;
  }
  while (next_chunk_ < index_->chunks.size()) {
    const Index::Chunk& chunk = index_->chunks[next_chunk_++];
    if (!wants(chunk)) continue;
    chunk_end_ = chunk.position;
    leave();
    return true;
  }
  return false;
}

void ChunkedBag::enter(const ChunkRecord& chunk) {
  const std::uint64_t begin = outer_.position();
  const std::uint64_t left = file_->size() - std::min(begin, file_->size());
  chunk_end_ = begin + std::min(chunk.packed_size, left);
  auto unpacked = decompressed(chunk.compression, std::make_unique<FileSection>(file_, begin, chunk_end_));
  if (!unpacked) {
    note_damage(fmt::format("compressed by '{}', which is not supported", chunk.compression));
    in_chunk_ = true;
    at_end_ = !go_on();
    return;
  }
  inner_.reset(checked(std::move(unpacked), chunk.size, chunk.crc32));
  in_chunk_ = true;
}

void ChunkedBag::leave() {
  outer_.reset(std::make_unique<FileSection>(file_, chunk_end_, std::numeric_limits<std::uint64_t>::max()),
               chunk_end_);
  in_chunk_ = false;
}

void ChunkedBag::note_damage(const std::string& what) {
  add_note(notes_,
           fmt::format("{}: {} at byte {} of {} is damaged or cut off ({}); only what comes before is used",
                       name_, in_chunk_ ? "the chunk" : "the record", record_position_, file_->size(), what));
}

double ChunkedBag::progress() const {
  const std::uint64_t passed = in_chunk_ ? record_position_ : outer_.position();
  return file_->size() == 0 ? 1.0 : static_cast<double>(passed) / static_cast<double>(file_->size());
}

}  // namespace waymark::bag
