#include "waymark/association/id_index.hpp"

#include <functional>

namespace waymark {

std::size_t IdIndex::Hash::operator()(LandmarkId id) const noexcept {
  return std::hash<std::int64_t>{}((std::int64_t{static_cast<std::uint8_t>(id.family)} << 32) ^ id.number);
}

std::optional<int> IdIndex::find(LandmarkId id) const {
  const auto found = slots_.find(id);
  return found == slots_.end() ? std::nullopt : std::optional(found->second);
}

}  // namespace waymark
