#include "workbench/report/pages.hpp"

#include <algorithm>

namespace waymark {

std::string safe_in_script(std::string_view json) {
  std::string safe;
  safe.reserve(json.size() + 64);
  for (std::size_t at = 0; at < json.size();) {
    const std::size_t next = std::min(json.find('<', at), json.size());
    safe += json.substr(at, next - at);
    if (next < json.size()) safe += "\\u003c";
    at = next + 1;
  }
  return safe;
}

std::string fill_page(std::string_view page, std::string_view json) {
  std::string html(page);
  return html.replace(html.find(kPageDataMark), kPageDataMark.size(), safe_in_script(json));
}

}  // namespace waymark
