#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace waymark {

/// Letters to insert, delete or replace to make one of the other (Levenshtein). O(a b).
[[nodiscard]] std::size_t edit_distance(std::string_view a, std::string_view b);

/// The name nearest to a mistyped one, for "did you mean": by edit_distance(), ties in order. Empty if none
/// is near.
[[nodiscard]] std::string nearest_name(std::string_view mistyped, const std::vector<std::string>& known);

/// "a, b, c".
[[nodiscard]] std::string comma_separated(const std::vector<std::string>& names);

/// "a, b or c".
[[nodiscard]] std::string one_of(const std::vector<std::string>& names);

}  // namespace waymark
