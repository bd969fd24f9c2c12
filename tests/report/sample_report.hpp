#pragma once

#include "workbench/report/report.hpp"

namespace waymark {

/// Two runs over one drive of `rows` poses on a circle past eight landmarks, with every part that a report
/// can have.
[[nodiscard]] ReportData sample_report(std::size_t rows);

}  // namespace waymark
