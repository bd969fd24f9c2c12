#pragma once

#include <string>
#include <string_view>

namespace waymark {

/// RFC 4648, with padding: how bytes stand in a data URL.
[[nodiscard]] std::string base64(std::string_view bytes);

}  // namespace waymark
