#pragma once

#include <string>

#include "workbench/report/report.hpp"

namespace waymark {

/// Rows of a series that are drawn; more than a screen has pixels.
inline constexpr std::size_t kMaxReportRows = 4000;

/// The data of the page as JSON that may stand inside an HTML script element: no `<` in it. Numbers have six
/// significant digits (stamps: 0.1 ms), those that are not finite are null.
[[nodiscard]] std::string report_json(const ReportData& data);

}  // namespace waymark
