#pragma once

#include <optional>
#include <unordered_map>

#include "waymark/core/observation.hpp"

namespace waymark {

/// Where in the state the landmark with a given identity stands. Look-ups do not allocate.
class IdIndex {
 public:
  explicit IdIndex(std::size_t capacity) { slots_.reserve(capacity); }

  [[nodiscard]] std::optional<int> find(LandmarkId id) const;
  /// Adds or moves.
  void assign(LandmarkId id, int slot) { slots_[id] = slot; }
  void erase(LandmarkId id) { slots_.erase(id); }

 private:
  struct Hash {
    std::size_t operator()(LandmarkId id) const noexcept;
  };
  std::unordered_map<LandmarkId, int, Hash> slots_;
};

}  // namespace waymark
