#pragma once

#include "waymark/core/result.hpp"

#include "workbench/logs/text_lines.hpp"

namespace waymark {

/// A comma-separated table, with or without a header, whose stamps, in the first column, were rounded to
/// whole seconds while its rows kept their order: the same rows, in columns between blanks and in the same
/// lines, with stamps that spread the rows of second s evenly over [s - 0.5, s + 0.5). Of the first and last
/// second only a part may have been recorded, so their rows are left out. An error names the line whose stamp
/// is no whole second or goes back in time. O(n).
[[nodiscard]] Result<TextLines> spread_rounded_stamps(TextLines lines);

}  // namespace waymark
