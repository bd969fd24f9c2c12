#include "waymark/report/report.hpp"

#include "waymark/io/files.hpp"
#include "waymark/report/report_json.hpp"
#include "waymark/report/report_page.hpp"

namespace waymark {

std::string render_report(const ReportData& data) {
  std::string html(report_page());
  return html.replace(html.find(kReportDataMark), kReportDataMark.size(), report_json(data));
}

Result<void> write_report(const ReportData& data, const std::filesystem::path& path) {
  return write_file(path, render_report(data));
}

}  // namespace waymark
