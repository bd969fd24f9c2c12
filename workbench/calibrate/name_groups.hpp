#pragma once

#include <string>
#include <vector>

namespace waymark::calibrate {

/// Some of the `names`, shortly: the pattern that only they match ("left*.jpg"), where what they have in
/// common is a word; else as ranges in the order of the names ("a01.jpg to a07.jpg, a10.jpg"), of which the
/// first few are told. `is_member` has one for each name, and at least one is true.
[[nodiscard]] std::string describe_members(const std::vector<std::string>& names,
                                           const std::vector<bool>& is_member);

}  // namespace waymark::calibrate
