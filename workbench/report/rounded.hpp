#pragma once

namespace waymark {

/// Six significant digits: enough for any chart and table, and half the size of all digits. What is not
/// finite stays so, and is null in JSON.
[[nodiscard]] double rounded(double value);

}  // namespace waymark
