#include "waymark/report/report.hpp"

#include "waymark/io/files.hpp"
#include "waymark/report/pages.hpp"
#include "waymark/report/report_json.hpp"

namespace waymark {

std::string render_report(const ReportData& data) { return fill_page(report_page(), report_json(data)); }

Result<void> write_report(const ReportData& data, const std::filesystem::path& path) {
  return write_file(path, render_report(data));
}

}  // namespace waymark
