#pragma once

#include <string_view>

namespace waymark {

/// The page that web/report/ is bundled into at build time, with kReportDataMark where its data belong.
[[nodiscard]] std::string_view report_page();

inline constexpr std::string_view kReportDataMark = "<!-- data -->";

}  // namespace waymark
