#pragma once

#include <string>

#include "workbench/report/report.hpp"
#include "workbench/report/results.hpp"

namespace waymark {

/// The report of one run: truth and dead reckoning of its log, and the run itself. `command` is what made it.
[[nodiscard]] ReportData make_report(const RunResult& result, const std::string& command);

/// Puts a further run over the same log beside the first.
void add_run_to(ReportData& report, const RunResult& result, const std::string& command);

}  // namespace waymark
