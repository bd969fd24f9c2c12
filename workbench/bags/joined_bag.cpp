#include "workbench/bags/joined_bag.hpp"

#include <algorithm>
#include <cstring>
#include <iterator>
#include <utility>

#include <fmt/format.h>

#include "workbench/bags/byte_stream.hpp"
#include "workbench/bags/decompress.hpp"
#include "workbench/bags/unpacked_file.hpp"

namespace waymark::bag {
namespace {

class MemoryStream final : public ByteStream {
 public:
  explicit MemoryStream(std::string_view bytes) : bytes_(bytes) {}

  [[nodiscard]] Result<std::size_t> read(std::span<char> into) override {
    const std::size_t count = std::min(into.size(), bytes_.size());
    std::memcpy(into.data(), bytes_.data(), count);
    bytes_.remove_prefix(count);
    return count;
  }

 private:
  std::string_view bytes_;
};

class JoinedBag final : public Reader {
 public:
  JoinedBag(std::vector<std::unique_ptr<Reader>> parts, std::vector<std::string> notes)
      : parts_(std::move(parts)), notes_(std::move(notes)) {
    for (const auto& part : parts_) {
      const Summary& summary = part->summary();
      summary_.format = summary.format;
      auto& places = places_.emplace_back();
      for (const Topic& topic : summary.topics) {
        Topic whole = topic;
        whole.messages = 0;
        places.push_back(place_topic(summary_.topics, std::move(whole)));
        summary_.topics[places.back()].messages += topic.messages;
      }
      for (const auto& stamp : {summary.first, summary.last})
        if (stamp) include(summary_, *stamp);
    }
    rewind(std::vector<bool>(summary_.topics.size(), true));
  }

  [[nodiscard]] const Summary& summary() const override { return summary_; }

  void rewind(std::vector<bool> wanted) override {
    for (std::size_t i = 0; i < parts_.size(); ++i) {
      std::vector<bool> of_part;
      for (const std::size_t place : places_[i]) of_part.push_back(place < wanted.size() && wanted[place]);
      parts_[i]->rewind(std::move(of_part));
    }
    part_ = 0;
  }

  [[nodiscard]] std::optional<Message> next() override {
    while (part_ < parts_.size()) {
      auto message = parts_[part_]->next();
      if (!message) {
        ++part_;
        continue;
      }
      message->topic = places_[part_][message->topic];
      const Topic& topic = summary_.topics[message->topic];
      if (topic.encoding != Encoding::kCdr || !is_zstd(message->bytes) || unpack(*message)) return message;
      add_note(notes_, fmt::format("messages of {} skipped whose zstd frames are damaged", topic.name));
    }
    return std::nullopt;
  }

  [[nodiscard]] std::vector<std::string> notes() const override {
    std::vector<std::string> all = notes_;
    for (const auto& part : parts_) std::ranges::move(part->notes(), std::back_inserter(all));
    return all;
  }

  [[nodiscard]] double progress() const override {
    const double of_part = part_ < parts_.size() ? parts_[part_]->progress() : 0.0;
    return (static_cast<double>(part_) + of_part) / static_cast<double>(parts_.size());
  }

 private:
  bool unpack(Message& message) {
    constexpr std::size_t kStep = 65536;
    const auto stream = decompressed("zstd", std::make_unique<MemoryStream>(message.bytes));
    std::size_t size = 0;
    while (size < kLargestPiece) {
      if (unpacked_.size() < size + kStep) unpacked_.resize(2 * size + kStep);
      const auto count = stream->read(std::span(unpacked_).subspan(size));
      if (!count) return false;
      if (*count == 0) break;
      size += *count;
    }
    message.bytes = std::string_view(unpacked_).substr(0, size);
    return size < kLargestPiece;
  }

  std::vector<std::unique_ptr<Reader>> parts_;
  std::vector<std::string> notes_;
  std::vector<std::vector<std::size_t>> places_;  // of each part's topics among all
  Summary summary_;
  std::size_t part_ = 0;
  std::string unpacked_;
};

}  // namespace

std::unique_ptr<Reader> join_bags(std::vector<std::unique_ptr<Reader>> parts,
                                  std::vector<std::string> notes) {
  return std::make_unique<JoinedBag>(std::move(parts), std::move(notes));
}

}  // namespace waymark::bag
