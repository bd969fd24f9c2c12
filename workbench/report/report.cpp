#include "workbench/report/report.hpp"

#include "workbench/logs/files.hpp"
#include "workbench/report/pages.hpp"
#include "workbench/report/report_json.hpp"

namespace waymark {

std::string render_report(const ReportData& data) { return fill_page(report_page(), report_json(data)); }

Result<void> write_report(const ReportData& data, const std::filesystem::path& path) {
  return write_file(path, render_report(data));
}

}  // namespace waymark
