// How fast a bag is read, beside how fast its bytes come off the disk cache or out of its decompressor. Give
// bags in the environment: WAYMARK_BAGS=a.bag:b.mcap. Times are thread CPU.
#include <cstdlib>
#include <sstream>

#include <benchmark/benchmark.h>
#include <lz4frame.h>

#include "workbench/bags/bag_source.hpp"
#include "workbench/bags/byte_stream.hpp"
#include "workbench/bags/open_bag.hpp"

namespace waymark {
namespace {

/// The file alone, in the blocks that the reader uses.
void read_file_alone(benchmark::State& state, const std::string& path) {
  std::vector<char> block(262144);
  std::int64_t bytes = 0;
  for (auto _ : state) {
    const auto file = bag::InputFile::open(path);
    bag::FileSection section(*file, 0, (*file)->size());
    for (auto count = section.read(block); count && *count > 0; count = section.read(block))
      bytes += static_cast<std::int64_t>(*count);
  }
  state.SetBytesProcessed(bytes);
}

/// All messages of all topics, not looked into. Bytes are those of the messages.
void read_messages(benchmark::State& state, const std::string& path) {
  std::int64_t bytes = 0;
  for (auto _ : state) {
    const auto reader = bag::open_bag(path);
    while (const auto message = (*reader)->next()) bytes += static_cast<std::int64_t>(message->bytes.size());
  }
  state.SetBytesProcessed(bytes);
}

/// All events, raw images as grey pixels.
void read_events(benchmark::State& state, const std::string& path) {
  std::int64_t events = 0;
  for (auto _ : state) {
    const auto source = open_bag_source(path, {});
    for (auto event = (*source)->next(); event && *event; event = (*source)->next()) ++events;
  }
  state.SetItemsProcessed(events);
}

using Bench = void (*)(benchmark::State&, const std::string&);

/// What the messages of the bag hold, in chunks as rosbag makes them, each a frame of LZ4.
std::vector<std::string> lz4_chunks(const std::string& path) {
  constexpr std::size_t kChunk = 768 * 1024;
  std::vector<std::string> chunks;
  std::string content;
  const auto pack = [&] {
    std::string packed(LZ4F_compressFrameBound(content.size(), nullptr), '\0');
    packed.resize(LZ4F_compressFrame(packed.data(), packed.size(), content.data(), content.size(), nullptr));
    chunks.push_back(std::move(packed));
    content.clear();
  };
  const auto reader = bag::open_bag(path);
  while (const auto message = (*reader)->next()) {
    content += message->bytes;
    if (content.size() >= kChunk) pack();
  }
  pack();
  return chunks;
}

/// liblz4 by itself on the same content.
void run_lz4_alone(benchmark::State& state, const std::string& path) {
  const auto chunks = lz4_chunks(path);
  std::vector<char> unpacked(64'000'000);
  LZ4F_dctx* context = nullptr;
  LZ4F_createDecompressionContext(&context, LZ4F_VERSION);
  std::int64_t bytes = 0;
  for (auto _ : state) {
    for (const auto& chunk : chunks) {
      std::size_t made = unpacked.size();
      std::size_t taken = chunk.size();
      LZ4F_decompress(context, unpacked.data(), &made, chunk.data(), &taken, nullptr);
      bytes += static_cast<std::int64_t>(made);
    }
  }
  LZ4F_freeDecompressionContext(context);
  state.SetBytesProcessed(bytes);
}

void register_all() {
  const char* named = std::getenv("WAYMARK_BAGS");
  std::istringstream paths(named == nullptr ? "" : named);
  for (std::string path; std::getline(paths, path, ':');)
    for (const auto& [what, run] : {std::pair<std::string, Bench>{"file ", read_file_alone},
                                    {"lz4 alone ", run_lz4_alone},
                                    {"messages ", read_messages},
                                    {"events ", read_events}})
      benchmark::RegisterBenchmark((what + path).c_str(), run, path)->Unit(benchmark::kMillisecond);
}

const bool kRegistered = (register_all(), true);

}  // namespace
}  // namespace waymark
