#include "workbench/config/load_yaml.hpp"

#include <algorithm>
#include <cstddef>
#include <map>
#include <sstream>
#include <vector>

#include <fmt/format.h>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/yaml.h>

namespace waymark {
namespace {

// A bag of ten thousand files has a metadata.yaml of a quarter of this; nothing else that is read comes near.
constexpr std::size_t kMaxBytes = std::size_t{8} << 20;
constexpr std::size_t kMaxNodes = 400'000;
constexpr std::size_t kMaxDepth = 64;

/// What a part of a text comes to when its aliases are replaced.
struct Extent {
  std::size_t nodes = 1;
  std::size_t bytes = 0;
  std::size_t depth = 1;

  void add(const Extent& part) {
    nodes += part.nodes;
    bytes += part.bytes;
    depth = std::max(depth, part.depth + 1);
  }
};

/// Adds up the extents of a text's parts while it is parsed, and ends that by an exception when they are too
/// much.
class ExtentMeter final : public YAML::EventHandler {
 public:
  void OnDocumentStart(const YAML::Mark& /*mark*/) override {}
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override { add_leaf(mark, anchor, 0); }
  void OnScalar(const YAML::Mark& mark, const std::string& /*tag*/, YAML::anchor_t anchor,
                const std::string& value) override {
    add_leaf(mark, anchor, value.size());
  }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    const auto known = known_.find(anchor);
    if (known == known_.end())
      throw YAML::ParserException(mark, "an alias refers to a node that contains it");
    add(mark, known->second);
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string& /*tag*/, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value /*style*/) override {
    begin(mark, anchor);
  }
  void OnSequenceEnd() override { end(); }
  void OnMapStart(const YAML::Mark& mark, const std::string& /*tag*/, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value /*style*/) override {
    begin(mark, anchor);
  }
  void OnMapEnd() override { end(); }

 private:
  /// A list or map that has begun.
  struct OpenPart {
    YAML::Mark mark;
    YAML::anchor_t anchor;
    Extent extent;
  };

  void add_leaf(const YAML::Mark& mark, YAML::anchor_t anchor, std::size_t bytes) {
    const Extent leaf{.bytes = bytes};
    if (anchor != YAML::NullAnchor) known_[anchor] = leaf;
    add(mark, leaf);
  }

  void begin(const YAML::Mark& mark, YAML::anchor_t anchor) {
    if (open_.size() == kMaxDepth) throw YAML::ParserException(mark, "nested too deep");
    open_.push_back({mark, anchor, {}});
  }

  void end() {
    const OpenPart part = open_.back();
    open_.pop_back();
    if (part.anchor != YAML::NullAnchor) known_[part.anchor] = part.extent;
    add(part.mark, part.extent);
  }

  void add(const YAML::Mark& mark, const Extent& part) {
    if (open_.empty()) return;
    Extent& whole = open_.back().extent;
    whole.add(part);
    if (whole.depth > kMaxDepth) throw YAML::ParserException(mark, "nested too deep");
    if (whole.nodes > kMaxNodes || whole.bytes > kMaxBytes)
      throw YAML::ParserException(mark, "too many values (those of aliases count, too)");
  }

  std::vector<OpenPart> open_;
  std::map<YAML::anchor_t, Extent> known_;
};

void check_extent(const std::string& yaml) {
  std::istringstream text(yaml);
  YAML::Parser parser(text);
  ExtentMeter meter;
  parser.HandleNextDocument(meter);
}

}  // namespace

Result<YAML::Node> load_yaml(const std::string& yaml, const std::string& name) {
  if (yaml.size() > kMaxBytes)
    return Error{
        fmt::format("{}: {} bytes of YAML are too many; at most {} are read", name, yaml.size(), kMaxBytes)};
  try {
    check_extent(yaml);
    return YAML::Load(yaml);
  } catch (const YAML::Exception& problem) {
    return Error{fmt::format("{}:{}: {}", name, problem.mark.line + 1, problem.msg)};
  }
}

}  // namespace waymark
